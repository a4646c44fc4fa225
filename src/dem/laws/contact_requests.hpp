// Requests to the contact kernels that one item per particle answers: the type of the request names the item.
#pragma once

#include <stdexcept>
#include <type_traits>
#include <variant>

#include "dem/contact/contact_items.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/implicit/friction_items.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/escape_items.hpp"
#include "dem/reports/output_fields.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "physics/single_contact.hpp"

namespace scree {

// Degrees of freedom of a particle in implicit steps with this law; 0: there are none.
template <class Law>
inline constexpr int kStepFreedoms = !Law::kNeedsMotion       ? 3
                                     : kHasFrictionSteps<Law> ? 6
                                                              : 0;

// At an instant: forces, and what moves with them; see `ContactForceItem`.
struct ForceRequest {
  Vec3 gravity;
  Vec3* force;
  Real* loss_power;
  Vec3* angular_acceleration;
};
// Elastic energy of escaped particles, one item each; and the removal of their contacts from all others.
struct EscapeRequest {
  RemainingSpace space;
  EscapedParticle* escaped_particles;
};
struct DepartureRequest {
  Vec3 gravity;
  RemainingSpace space;
  StartViews start;
};

// Over an implicit step: forces and Newton matrix of the particles. With three degrees of freedom the
// particles do not rotate: the last three members are not used, nor is `start` but for `start.step`.
struct StepSystem {
  Vec3 gravity;
  NewtonWeights weights;
  FrictionStart start;
  StepForces forces;
  ContactMatrix matrix;  // with three degrees of freedom
  StepTorques torques;
  FrictionMatrix friction_matrix;
  Real* phase_squared;
};
// Energy accounting of an accepted step, and the history of its contacts; the friction limits at an iterate.
struct LossRequest {
  FrictionStart start;
  FrictionLossOutputs to;
};
struct LimitRequest {
  FrictionStart start;
  LaggedLimits to;
};

// Contacts of shapes of bodies with each other and with surfaces: at an instant or over an explicit step, and
// over an implicit one. The history of a step is stored.
struct BodyLoadRequest {
  const Vec3* arm;  // of their centres from the bodies' centres [m]
  Real h;  // length of the explicit step that ends now, for laws with `kNeedsMotion` [s]; 0: an instant
  BodyLoad* out;
};
struct BodyStepRequest {
  FrictionStart start;
  const Vec3* arm;  // at the end of the step
  BodyStep* out;
  ShapeContactsTo to;
};

// Requests to any backend, and to the CPU, where a GPU has kernels of its own or the bodies' shapes are on
// the host.
using ContactRequest = std::variant<ForceRequest, EnergyOutputs, OutputRequest, LineRequest, EscapeRequest,
                                    DepartureRequest, LossRequest, LimitRequest>;
using CpuRequest =
    std::variant<ForceRequest, EnergyOutputs, OutputRequest, LineRequest, EscapeRequest, DepartureRequest,
                 LossRequest, LimitRequest, StepSystem, BodyLoadRequest, BodyStepRequest>;

// Calls run(item) with the item of a request.
template <class Laws, class Rows, class Run>
struct WithRequestedItem {
  const ContactViews<Rows>& in;
  const Laws& laws;
  const Run& run;

  using Law = LawOf<Laws>;

  void operator()(const ForceRequest& r) const {
    run(ContactForceItem<Laws, Rows>{{in, laws}, r.gravity, r.force, r.loss_power, r.angular_acceleration});
  }
  void operator()(const EnergyOutputs& out) const { run(ContactEnergyItem<Laws, Rows>{{in, laws}, out}); }
  void operator()(const OutputRequest& r) const {
    with_contact_output(r, ContactWalk<Laws, Rows>{in, laws}, run);
  }
  void operator()(const LineRequest& r) const { run(ContactLineItem<Laws, Rows>{{in, laws}, r}); }
  void operator()(const EscapeRequest& r) const {
    run(EscapeEnergyItem<Laws, Rows>{{in, laws}, r.space, r.escaped_particles});
  }
  void operator()(const DepartureRequest& r) const {
    run(EscapedContactsItem<Laws, Rows>{{in, laws}, r.gravity, r.space, r.start});
  }
  void operator()(const StepSystem& r) const {
    if constexpr (kStepFreedoms<Law> == 6)
      run(FrictionSystemItem<Laws, Rows>{{in, laws, {r.start}},
                                         r.gravity,
                                         r.weights,
                                         r.forces,
                                         r.torques,
                                         r.friction_matrix,
                                         r.phase_squared});
    else if constexpr (kStepFreedoms<Law> == 3)
      run(ContactSystemItem<Laws, Rows>{
          {in, laws, {r.start.step}}, r.gravity, r.weights, r.forces, r.matrix});
    else
      refuse_implicit();
  }
  void operator()(const LossRequest& r) const {
    if constexpr (kStepFreedoms<Law> == 6)
      run(FrictionLossesItem<Laws, Rows>{{in, laws, {r.start}}, r.to});
    else if constexpr (kStepFreedoms<Law> == 3)
      run(ContactLossesItem<Laws, Rows>{{in, laws, {r.start.step}}, r.to.contact, r.to.integrator});
    else
      refuse_implicit();
  }
  void operator()(const LimitRequest& r) const {
    if constexpr (kStepFreedoms<Law> == 6)
      run(LaggedLimitItem<Laws, Rows>{{in, laws, {r.start}}, r.to});
    else
      refuse_implicit();
  }
  void operator()(const BodyLoadRequest& r) const {
    if constexpr (Law::kNeedsMotion)
      if (r.h > 0) return run(BodyLoadItem<Laws, Rows, OverExplicitStep>{{in, laws, {r.h}}, r.arm, r.out});
    run(BodyLoadItem<Laws, Rows, InstantKinematics<Laws>>{{in, laws}, r.arm, r.out});
  }
  void operator()(const BodyStepRequest& r) const {
    if constexpr (kStepFreedoms<Law> == 6)
      run(BodyFrictionItem<Laws, Rows>{{in, laws, {r.start}}, r.arm, r.out, r.to});
    else if constexpr (kStepFreedoms<Law> == 3)
      run(BodyStepItem<Laws, Rows>{{in, laws, {r.start.step}}, r.arm, r.out, r.to});
    else
      refuse_implicit();
  }

  [[noreturn]] static void refuse_implicit() {
    throw std::logic_error("contact kernels: the law has no such implicit steps");
  }
};
template <class Laws, class Rows, class Request, class Run>
void with_requested_item(const ContactViews<Rows>& in, const Laws& laws, const Request& request,
                         const Run& run) {
  std::visit(WithRequestedItem<Laws, Rows, Run>{in, laws, run}, request);
}

// What a backend needs to know about the law of a run.
struct LawTraits {
  int history;     // numbers of history per contact
  bool rolls;      // whether its type has rolling resistance
  bool has_range;  // whether contacts may exist beyond touch
  bool is_mixed;   // whether it has explicit steps in mixed precision

  template <class Law>
  static LawTraits of() {
    return {Law::kHistory, Law::Rolling::acts, Law::kHasRange,
            Law::kNeedsMotion ? kHasSingleForm<Law> : !Law::kHasRange};
  }
};

}  // namespace scree
