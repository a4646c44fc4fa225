#include "deck/pair_laws.hpp"

namespace scree {

const std::vector<PairLaw>& pair_laws() {
  static const std::vector<PairLaw> laws = {
#define SCREE_PAIR_LAW(name) pair_law_list::name(),
#include "physics/contact_laws.def"
#undef SCREE_PAIR_LAW
  };
  return laws;
}

}  // namespace scree
