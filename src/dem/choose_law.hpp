// The choice of the contact law, once per run: what is made for its type is monomorphic.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

#include "model/model.hpp"
#include "physics/contact_law.hpp"

namespace scree {

// The friction that goes with a normal law.
template <class Normal>
using SliderOf = std::conditional_t<std::is_same_v<Normal, HertzLaw>, MindlinSlider, LinearSlider>;

// Of all pairs of materials, in the order of Contact::laws, which `Law` accepts.
template <class Law>
std::vector<Law> laws_of(const Contact& contact) {
  std::vector<Law> laws;
  for (std::size_t k = 0; k < contact.laws.size(); ++k) {
    Law& law = laws.emplace_back();
    law.normal = typename Law::Normal(contact.laws[k]);
    if constexpr (Law::Tangential::acts) law.tangential = Law::Tangential::of(contact.friction[k]);
    if constexpr (Law::Rolling::acts) law.rolling = Law::Rolling::of(contact.rolling[k]);
  }
  return laws;
}

// Laws with rolling resistance are those of all linear springs: one with and without a damping ratio.
template <class Normal>
inline constexpr bool kRolls = !std::is_same_v<Normal, LinearLaw>;

// Calls use(laws) with the laws of all pairs of materials as a std::vector<ContactLaw<...>>: of the first of
// NormalLaws that accepts them all, with friction where contacts rub, and with all that resists rolling where
// some does. Returns what use returns, the same type for every law.
template <std::size_t kFirst = 0, class Use>
auto with_contact_laws(const Contact& contact, const Use& use) {
  using Normal = std::tuple_element_t<kFirst, NormalLaws>;
  const bool rolls = !contact.rolling.empty();
  const bool accepts =
      std::all_of(contact.laws.begin(), contact.laws.end(), Normal::accepts) && (kRolls<Normal> || !rolls);
  if constexpr (kFirst + 1 < std::tuple_size_v<NormalLaws>)
    if (!accepts) return with_contact_laws<kFirst + 1>(contact, use);
  if (!accepts) throw std::logic_error("with_contact_laws: no law accepts all pairs of materials");
  if constexpr (kRolls<Normal>)
    if (rolls) return use(laws_of<ContactLaw<Normal, SliderOf<Normal>, AnyRolling>>(contact));
  if (contact.friction.empty()) return use(laws_of<ContactLaw<Normal>>(contact));
  return use(laws_of<ContactLaw<Normal, SliderOf<Normal>>>(contact));
}

// How many numbers the law remembers of a contact.
inline int history_of(const Contact& contact) {
  return with_contact_laws(contact, []<class Law>(const std::vector<Law>&) { return Law::kHistory; });
}

}  // namespace scree
