#include "mbs/violated_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "mbs/energy_ledger.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 1e-9;    // of 1 rad or the length scale
constexpr Real kSlow = 1e-3;        // per second, of 1 rad or the length scale
constexpr Real kMostStored = 1000;  // times the energy of everything else

}  // namespace

std::vector<Stop> stops_of(const Model& model) {
  std::vector<Stop> stops;
  std::size_t number = model.motors.size() + model.joint_springs.size();  // the order of JointForces
  for (const JointLimit& limit : model.joint_limits)
    stops.push_back({fmt::format("joint limit '{}'", limit.name),
                     model.joints[static_cast<std::size_t>(limit.joint)].name, limit.lower, limit.upper,
                     limit.exponent, number++});
  return stops;
}

std::vector<std::string> violated_limits(const RigidBodySystem& system, const std::vector<Stop>& stops,
                                         const MultibodyState& start, Real weight) {
  std::vector<std::string> findings;
  if (stops.empty()) return findings;
  const SystemInstant at{0, start.position, start.velocity, &start.multipliers, &start.acceleration};
  const BodyPoses poses = system.poses_at(at);
  const std::vector<JointForce::Sample> samples = system.joint_forces().samples(poses, at, start.memory);
  const MultibodyEnergies energies = stored_energies(system, start, 0);
  for (const Stop& stop : stops) {
    const JointForce& force = system.joint_forces().all()[stop.number];
    const JointForce::Sample& sample = samples[stop.number];
    const bool below = sample.at.value < stop.lower;
    const Real limit = below ? stop.lower : stop.upper, out = below ? 1 : -1,
               passed = out * (limit - sample.at.value), scale = force.is_angle() ? 1 : system.length_scale();
    if (!(passed > kRoundOff * scale)) continue;
    // (c')^2 / 2 = c'' d / (n + 1), where only the force of the limit changes during the return.
    const Real speed =
        std::sqrt(std::max(out * sample.at.second * passed * 2 / (stop.exponent + 1), Real(0)));
    if (!(speed > kSlow * scale)) continue;
    const Real stored = force.elastic_energy(poses, 0, 0),
               other = energies.kinetic + energies.elastic - stored + weight * system.length_scale();
    const char* const unit = force.is_angle() ? "rad" : "m";
    const std::string text = fmt::format(
        "{0}: violated at t = 0: joint '{1}' is at {2:.6g} {3}, {4:.4g} {3} {5} = {6:.6g}. The limit starts "
        "with {7:.4g} {8}, stores {9:.4g} J and accelerates the joint to up to {10:.3g} {3}/s",
        stop.title, stop.joint, sample.at.value, unit, passed, below ? "below lower" : "above upper", limit,
        sample.effort, force.is_angle() ? "N m" : "N", stored, speed);
    const std::string remedy = "start the joint within its limits, or move this one";
    if (other > 0 && stored > kMostStored * other)
      throw InputError(
          fmt::format("{}, where weights and motion at t = 0 have {:.3g} J; {}", text, other, remedy));
    findings.push_back(text + "; " + remedy);
  }
  return findings;
}

}  // namespace scree
