// Parameters that one contact law alone has, beside those of contact_parameters.hpp, with the functions that
// estimates of steps and overlaps, checks and messages use. The model stores them without their type: a law's
// header declares the type, and the law's file in the room deck makes the parameters from the deck.
#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// The functions return here what holds for a law without parameters of its own. A law overrides key(),
// numbers(), and those others in which it differs.
class OwnParameters {
 public:
  virtual ~OwnParameters() = default;

  // The deck's key that stands for the law in messages.
  virtual const char* key() const { return ""; }
  // All numbers on which trial impacts depend.
  virtual std::vector<Real> numbers() const { return {}; }
  // For `scree check`: the name of the law, and numbers with their names.
  virtual std::string title() const { return ""; }
  virtual std::vector<std::pair<std::string, Real>> facts() const { return {}; }
  // Why the law has no implicit steps; empty: it has them.
  virtual std::string explicit_only() const { return ""; }

  // Of a normal law: whether its force may be tensile without damping.
  virtual bool attracts() const { return false; }
  // Whether its force is K d where that of the law without these parameters is.
  virtual bool is_linear() const { return true; }
  // Its largest interaction range beyond touch [m], for particles of at most this radius.
  virtual Real interaction_range(Real) const { return 0; }
  // Its damping at small overlaps, beside that of the law without these parameters [N s/m], and whether that
  // depends on the partners.
  virtual Real damping(const PairSize&) const { return 0; }
  virtual bool depends_on_size() const { return false; }
  // The largest stiffness of its own force [N/m].
  virtual Real stiffness(const PairSize&) const { return 0; }
  // The stiffness of unloading where that of loading is `loading` [N/m].
  virtual Real unloading_stiffness(Real loading) const { return loading; }
  // The speed below which undamped impacts stick [m/s]; mass: m* [kg].
  virtual Real sticking_speed(const PairSize&, Real) const { return 0; }
  // The longest explicit step for its own force [s], mass: m* [kg]; and the reason, for the user. pair: the
  // names of the two materials.
  virtual Real longest_step(const PairSize&, Real) const { return kInfinity; }
  virtual std::string step_reason(const std::string&) const { return ""; }

  // Of a tangential law: its stiffness at this contact radius [N/m].
  virtual Real slip_stiffness(Real) const { return 0; }
  // Of a rolling law: its stiffness where that of the normal force is this [N m].
  virtual Real rolling_stiffness(const PairSize&, Real) const { return 0; }
};

// Parameters of a type that the law alone declares; or none.
class AnyParameters {
 public:
  AnyParameters() = default;
  template <class Own>
  requires std::is_base_of_v<OwnParameters, Own> AnyParameters(const Own& own)
      : own_(std::make_shared<const Own>(own)) {}

  explicit operator bool() const { return own_ != nullptr; }
  const OwnParameters* operator->() const {
    static const OwnParameters none;
    return own_ ? own_.get() : &none;
  }
  // Null where they are not of this type.
  template <class Own>
  const Own* as() const {
    return dynamic_cast<const Own*>(own_.get());
  }
  // Parameters of this type, those that its default constructor makes where there are none.
  template <class Own>
  Own value() const {
    return as<Own>() ? *as<Own>() : Own{};
  }
  // Whether there are none but of this type.
  template <class Own>
  bool are_only() const {
    return !own_ || as<Own>();
  }

 private:
  std::shared_ptr<const OwnParameters> own_;
};

}  // namespace scree
