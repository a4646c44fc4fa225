// The contact laws of the program as types, from the list contact_laws.def.
#pragma once

#include <tuple>
#include <type_traits>

#include "physics/contact_law.hpp"
#include "physics/rolling_laws.hpp"

#define SCREE_LAW_HEADERS
#include "physics/contact_laws.def"
#undef SCREE_LAW_HEADERS

namespace scree {

// Forms of a contact law: the normal law alone; with friction; with friction and every kind of rolling and
// twisting resistance.
enum class LawForm : unsigned { plain = 1, friction = 2, rolling = 4 };

// The rolling law of the form with rolling resistance: AnyRolling, unless the tangential law names another
// one as its `Rolling`.
template <class TangentialLaw>
struct RollingBeside {
  using Type = AnyRolling;
};
template <class TangentialLaw>
requires requires { typename TangentialLaw::Rolling; }
struct RollingBeside<TangentialLaw> {
  using Type = typename TangentialLaw::Rolling;
};
template <class TangentialLaw>
using RollingOf = typename RollingBeside<TangentialLaw>::Type;

template <class NormalLaw, class TangentialLaw, LawForm kForm>
using ContactLawOf =
    std::conditional_t<kForm == LawForm::plain, ContactLaw<NormalLaw>,
                       std::conditional_t<kForm == LawForm::friction, ContactLaw<NormalLaw, TangentialLaw>,
                                          ContactLaw<NormalLaw, TangentialLaw, RollingOf<TangentialLaw>>>>;

// A normal law with the tangential law beside it. kForms: sum of the forms that exist.
template <class NormalLaw, class TangentialLaw, unsigned kForms>
struct LawFamily {
  using Normal = NormalLaw;
  template <LawForm kForm>
  using Law = ContactLawOf<NormalLaw, TangentialLaw, kForm>;

  static constexpr bool has(LawForm form) { return (kForms & static_cast<unsigned>(form)) != 0; }
  // Whether the family serves a pair with these parameters. Parameters of a law's own are accepted by that
  // law alone.
  static bool accepts(const NormalLawParameters& normal) { return NormalLaw::accepts(normal); }
  static bool accepts(const Friction& friction) {
    if constexpr (requires { TangentialLaw::accepts(friction); })
      return TangentialLaw::accepts(friction);
    else
      return !friction.own;
  }
  static bool accepts(const RollingParameters& rolling) {
    if constexpr (requires { RollingOf<TangentialLaw>::accepts(rolling); })
      return RollingOf<TangentialLaw>::accepts(rolling);
    else
      return !rolling.own;
  }
  // Whether a deck's pairs have a form; those with friction alone may take that with rolling resistance.
  static constexpr bool serves(bool has_friction, bool rolls) {
    if (!has_friction) return has(LawForm::plain);
    return has(LawForm::rolling) || (!rolls && has(LawForm::friction));
  }
};

namespace law_list {
inline constexpr unsigned plain = static_cast<unsigned>(LawForm::plain),
                          friction = static_cast<unsigned>(LawForm::friction),
                          rolling = static_cast<unsigned>(LawForm::rolling);
#define SCREE_CONTACT_LAW(name, Normal, Tangential, forms) LawFamily<Normal, Tangential, forms>
using Families = std::tuple<
#include "physics/contact_laws.def"
    >;
#undef SCREE_CONTACT_LAW
}  // namespace law_list

using LawFamilies = law_list::Families;

}  // namespace scree
