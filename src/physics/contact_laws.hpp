// The contact laws of the program as types, from the list contact_laws.def.
#pragma once

#include <tuple>
#include <type_traits>

#include "physics/cohesion.hpp"
#include "physics/contact_law.hpp"
#include "physics/eepa.hpp"
#include "physics/liquid_bridge.hpp"
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

// Forms of a contact law: the normal law alone; with friction; with friction and every kind of rolling and
// twisting resistance.
enum class LawForm : unsigned { plain = 1, friction = 2, rolling = 4 };

template <class NormalLaw, class TangentialLaw, LawForm kForm>
using ContactLawOf =
    std::conditional_t<kForm == LawForm::plain, ContactLaw<NormalLaw>,
                       std::conditional_t<kForm == LawForm::friction, ContactLaw<NormalLaw, TangentialLaw>,
                                          ContactLaw<NormalLaw, TangentialLaw, AnyRolling>>>;

// A normal law with the tangential law beside it. kForms: sum of the forms that exist.
template <class NormalLaw, class TangentialLaw, unsigned kForms>
struct LawFamily {
  using Normal = NormalLaw;
  template <LawForm kForm>
  using Law = ContactLawOf<NormalLaw, TangentialLaw, kForm>;

  static constexpr bool has(LawForm form) { return (kForms & static_cast<unsigned>(form)) != 0; }
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
