// The contact law, chosen once per run: the code for its type is monomorphic.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

#include "model/data/model.hpp"
#include "physics/cohesion.hpp"
#include "physics/contact_law.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

// Tangential and rolling laws that are combined with a normal law.
template <class Normal>
struct Beside {
  using Slider = LinearSlider;
  static constexpr bool is_cohesive = false;
};
template <>
struct Beside<HertzLaw> {
  using Slider = MindlinSlider;
  static constexpr bool is_cohesive = false;
};
template <>
struct Beside<JkrLaw> {
  using Slider = MindlinSlider;
  static constexpr bool is_cohesive = true;
};
template <class Repulsion>
struct Beside<CohesiveLaw<Repulsion>> {
  using Slider = typename Beside<Repulsion>::Slider;
  static constexpr bool is_cohesive = true;
};

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

// Whether the normal law has a form with rolling resistance. LinearLaw has none: the law of all linear
// springs, with or without a damping ratio, takes its place.
template <class Normal>
inline constexpr bool kRolls = !std::is_same_v<Normal, LinearLaw>;

// Calls use(laws) with the laws of all pairs of materials as a std::vector<ContactLaw<...>>. The normal law
// is the first of NormalLaws that accepts all pairs; friction is included where contacts have it, and all
// kinds of rolling resistance where some contact has one. Adhesive laws with friction always include rolling
// resistance, and so do all JKR laws. Returns the result of use, which has one type for all laws.
template <std::size_t kFirst = 0, class Use>
auto with_contact_laws(const Contact& contact, const Use& use) {
  using Normal = std::tuple_element_t<kFirst, NormalLaws>;
  using Slider = typename Beside<Normal>::Slider;
  constexpr bool is_cohesive = Beside<Normal>::is_cohesive;
  const bool rolls = !contact.rolling.empty(), has_friction = !contact.friction.empty();
  const bool accepts = std::all_of(contact.laws.begin(), contact.laws.end(), Normal::accepts) &&
                       (kRolls<Normal> || !rolls) && (!kIsHysteretic<Normal> || has_friction);
  if constexpr (kFirst + 1 < std::tuple_size_v<NormalLaws>)
    if (!accepts) return with_contact_laws<kFirst + 1>(contact, use);
  if (!accepts) throw std::logic_error("with_contact_laws: no law accepts all pairs of materials");
  if constexpr (kIsHysteretic<Normal>) {
    return use(laws_of<ContactLaw<Normal, Slider, AnyRolling>>(contact));
  } else {
    if (!has_friction) return use(laws_of<ContactLaw<Normal>>(contact));
    if constexpr (kRolls<Normal>)
      if (rolls || is_cohesive) return use(laws_of<ContactLaw<Normal, Slider, AnyRolling>>(contact));
    if constexpr (!is_cohesive)
      return use(laws_of<ContactLaw<Normal, Slider>>(contact));
    else
      throw std::logic_error("with_contact_laws: a law that attracts has no form without rolling");
  }
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
    const auto refused =
        std::ranges::find_if_not(contact_.laws, std::tuple_element_t<kFirst, NormalLaws>::accepts);
    if (refused != contact_.laws.end())
      deciding_.push_back(static_cast<std::size_t>(refused - contact_.laws.begin()));
    if constexpr (kFirst + 1 < std::tuple_size_v<NormalLaws>) find_deciding<kFirst + 1>();
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
