// The contact law, chosen once per run: the code for its type is monomorphic.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

#include "model/data/model.hpp"
#include "physics/contact_laws.hpp"

namespace scree {

// The laws of all pairs of materials, in the order of Contact::laws. `Law` accepts them all.
template <class Law>
std::vector<Law> laws_of(const Contact& contact) {
  std::vector<Law> laws;
  for (std::size_t k = 0; k < contact.laws.size(); ++k) {
    Law& law = laws.emplace_back();
    law.normal = typename Law::Normal(contact.laws[k]);
    if constexpr (Law::Tangential::acts) law.tangential = Law::Tangential::of(contact.friction[k]);
    if constexpr (Law::Rolling::acts)
      if (!contact.rolling.empty()) law.rolling = Law::Rolling::of(contact.rolling[k]);
  }
  return laws;
}

// Whether a family of the list accepts the k-th pair of Contact::laws.
template <class Family>
bool accepts_pair(const Contact& contact, std::size_t k) {
  return Family::accepts(contact.laws[k]) &&
         (contact.friction.empty() || Family::accepts(contact.friction[k])) &&
         (contact.rolling.empty() || Family::accepts(contact.rolling[k]));
}
template <class Family>
bool accepts_all(const Contact& contact) {
  for (std::size_t k = 0; k < contact.laws.size(); ++k)
    if (!accepts_pair<Family>(contact, k)) return false;
  return true;
}

// Whether any family of the list satisfies is_so(family).
template <std::size_t kFirst = 0, class IsSo>
bool any_family(const IsSo& is_so) {
  if (is_so(std::tuple_element_t<kFirst, LawFamilies>{})) return true;
  if constexpr (kFirst + 1 < std::tuple_size_v<LawFamilies>)
    return any_family<kFirst + 1>(is_so);
  else
    return false;
}
// Whether the laws that accept these parameters exist only with friction: their contacts rotate with the
// partners.
inline bool needs_friction(const NormalLawParameters& law) {
  return !any_family(
      [&]<class Family>(Family) { return Family::accepts(law) && Family::has(LawForm::plain); });
}
// Whether with_contact_laws() finds a law.
inline bool has_contact_law(const Contact& contact) {
  return any_family([&]<class Family>(Family) {
    return accepts_all<Family>(contact) &&
           Family::serves(!contact.friction.empty(), !contact.rolling.empty());
  });
}

// Calls use(laws) with the laws of all pairs of materials as a std::vector<ContactLaw<...>>. The normal law
// is the first of the list that accepts all pairs and has the form that they need: with friction where
// contacts have it, with all kinds of rolling resistance where some contact has one. Returns the result of
// use, which has one type for all laws.
template <std::size_t kFirst = 0, class Use>
auto with_contact_laws(const Contact& contact, const Use& use) {
  using Family = std::tuple_element_t<kFirst, LawFamilies>;
  const bool rolls = !contact.rolling.empty(), has_friction = !contact.friction.empty();
  const bool fits = accepts_all<Family>(contact) && Family::serves(has_friction, rolls);
  if constexpr (kFirst + 1 < std::tuple_size_v<LawFamilies>)
    if (!fits) return with_contact_laws<kFirst + 1>(contact, use);
  if (fits) {
    if constexpr (Family::has(LawForm::plain))
      if (!has_friction) return use(laws_of<typename Family::template Law<LawForm::plain>>(contact));
    if constexpr (Family::has(LawForm::friction))
      if (!rolls) return use(laws_of<typename Family::template Law<LawForm::friction>>(contact));
    if constexpr (Family::has(LawForm::rolling))
      return use(laws_of<typename Family::template Law<LawForm::rolling>>(contact));
  }
  throw std::logic_error("with_contact_laws: no law accepts all pairs of materials");
}

// The laws of the pairs of materials one by one, with the types that with_contact_laws() selects for all of
// them together.
class PairLaws {
 public:
  explicit PairLaws(const Contact& contact) : contact_(contact) { find_deciding(); }

  // pair: index into Contact::laws. Returns what use(law) returns.
  template <class Use>
  auto with(std::size_t pair, const Use& use) const {
    Contact few;
    take(pair, few);
    for (const std::size_t other : deciding_) take(other, few);
    return with_contact_laws(few, [&](const auto& laws) { return use(laws.front()); });
  }

 private:
  template <std::size_t kFirst = 0>
  void find_deciding() {
    std::size_t k = 0;
    while (k < contact_.laws.size() && accepts_pair<std::tuple_element_t<kFirst, LawFamilies>>(contact_, k))
      ++k;
    if (k < contact_.laws.size()) deciding_.push_back(k);
    if constexpr (kFirst + 1 < std::tuple_size_v<LawFamilies>) find_deciding<kFirst + 1>();
  }
  void take(std::size_t pair, Contact& few) const {
    few.laws.push_back(contact_.laws[pair]);
    if (!contact_.friction.empty()) few.friction.push_back(contact_.friction[pair]);
    if (!contact_.rolling.empty()) few.rolling.push_back(contact_.rolling[pair]);
  }

  const Contact& contact_;
  std::vector<std::size_t> deciding_;
};

// Number of values in the history of one contact.
inline int history_of(const Contact& contact) {
  return with_contact_laws(contact, []<class Law>(const std::vector<Law>&) { return Law::kHistory; });
}

}  // namespace scree
