// The choice of the contact law, once per run: what is made for its type is monomorphic.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "model/model.hpp"
#include "physics/contact_law.hpp"

namespace scree {

// Calls use(laws) with the laws of all pairs of materials, Contact::laws as a std::vector<ContactLaw<...>>:
// of the first of NormalLaws that accepts them all. Returns what use returns, the same type for every law.
template <std::size_t kFirst = 0, class Use>
auto with_contact_laws(const Contact& contact, const Use& use) {
  using Law = std::tuple_element_t<kFirst, NormalLaws>;
  if constexpr (kFirst + 1 < std::tuple_size_v<NormalLaws>)
    if (!std::all_of(contact.laws.begin(), contact.laws.end(), Law::accepts))
      return with_contact_laws<kFirst + 1>(contact, use);
  std::vector<ContactLaw<Law>> laws;
  for (const KelvinVoigt& pair : contact.laws) {
    if (!Law::accepts(pair))
      throw std::logic_error("with_contact_laws: no law accepts all pairs of materials");
    laws.push_back({Law(pair)});
  }
  return use(laws);
}

// How many numbers the law remembers of a contact.
inline int history_of(const Contact& contact) {
  return with_contact_laws(contact, []<class Law>(const std::vector<Law>&) { return Law::kHistory; });
}

}  // namespace scree
