#include "run/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/printable.hpp"
#include "dem/device.hpp"
#include "model/limits.hpp"
#include "model/memory.hpp"

namespace scree {

namespace {

// Estimate of what one coordinate or constraint of the multibody side keeps in memory: a few vectors and the
// sparse factors.
constexpr Real kBytesPerUnknown = 1000;

int constraint_count(const Model& model) {
  int count = static_cast<int>(model.drivers.size());
  for (const Joint& joint : model.joints) {
    if (joint.kind == JointKind::fixed) count += 3;
    if (joint.kind == JointKind::revolute || joint.kind == JointKind::translational) count += 2;
    if (joint.kind == JointKind::distance) count += 1;
  }
  return count;
}

std::string range(Real smallest, Real largest, const char* unit) {
  if (smallest == largest) return fmt::format("{:.6g} {}", smallest, unit);
  return fmt::format("{:.6g} to {:.6g} {}", smallest, largest, unit);
}

std::string space_lines(const Model& model, int ranks) {
  const Space& space = model.space;
  const auto corner = [&](Vec3 p) {
    return space.dimension == 2 ? fmt::format("({}, {})", p.x, p.y)
                                : fmt::format("({}, {}, {})", p.x, p.y, p.z);
  };
  std::string lines = fmt::format("space          {}D, {} to {} m, {} wall(s)\n", space.dimension,
                                  corner(space.min), corner(space.max), model.walls.size());
  const ParticleTotals& particles = model.particles.totals;
  if (particles.count == 0) return lines + "particles      none\n";
  return lines + fmt::format("particles      {}{}, radius {}, mass {}\n", particles.count,
                             ranks == 1 ? "" : fmt::format(" on {} ranks together", ranks),
                             range(particles.smallest_radius, particles.largest_radius, "m"),
                             range(particles.smallest_mass, particles.largest_mass, "kg"));
}

std::string multibody_lines(const Model& model) {
  if (model.bodies.empty()) return "bodies         none\n";
  std::size_t shapes = 0;
  for (const Body& body : model.bodies) shapes += body.shapes.size();
  const int coordinates = 3 * static_cast<int>(model.bodies.size()), constraints = constraint_count(model);
  return fmt::format("bodies         {} with {} shape(s), {} joint(s), {} driver(s), {} force element(s)\n",
                     model.bodies.size(), shapes, model.joints.size(), model.drivers.size(),
                     model.spring_dampers.size() + model.torsional_spring_dampers.size() +
                         model.applied_forces.size()) +
         fmt::format("unknowns       {} coordinates, {} constraints: {} degrees of freedom\n", coordinates,
                     constraints, coordinates - constraints);
}

std::string limit_lines(const Model& model) {
  std::string lines;
  const std::vector<std::string>& names = model.contact.material_names;
  for (const PairLimit& limit : pair_limits(model)) {
    const KelvinVoigt& law = model.contact.law(limit.material[0], limit.material[1]);
    lines += fmt::format("contact        \"{}\" on \"{}\": K = {:.6g} N/m{}, C = {:.6g} N s/m, {}\n",
                         names[static_cast<std::size_t>(limit.material[0])],
                         names[static_cast<std::size_t>(limit.material[1])], law.normal_stiffness,
                         law.exponent == 1 ? "" : fmt::format("^{}", law.exponent), law.normal_damping,
                         law.tension ? "may pull" : "cut at zero");
    lines += fmt::format("               shortest contact {:.4g} s{}, resolved at steps up to {:.2g} s\n",
                         limit.contact_time, law.exponent == 1 ? "" : " (at 1 % overlap)",
                         0.2 * limit.contact_time);
    if (limit.explicit_step > 0) {
      lines += fmt::format("               velocity-verlet in dense contact: steps up to {:.4g} s\n",
                           limit.explicit_step);
    }
  }
  return lines;
}

std::string time_lines(const Model& model) {
  const TimeControl& time = model.time;
  const Integrator& integrator = model.integrator;
  const bool fixed = time.control == StepControl::fixed;
  std::string lines = fmt::format("time           0 to {} s, ", time.end);
  lines += fixed
               ? fmt::format("fixed step {} s ({:.0f} steps)\n", time.step, std::ceil(time.end / time.step))
               : fmt::format("adaptive steps from {:.4g} to {:.4g} s, the first of {:.4g} s, tolerance {}\n",
                             time.min_step, time.max_step, time.step, time.tolerance);
  const std::string particles = integrator.particles == ParticleIntegrator::hht
                                    ? "the same"
                                    : fmt::format("velocity-verlet, {} substep(s)", integrator.substeps);
  return lines + fmt::format("integrator     bodies HHT with alpha = {}; particles {}\n",
                             integrator.hht_alpha, particles);
}

std::string megabytes(Real bytes) { return fmt::format("{:.{}f} MB", bytes / 1e6, bytes < 1e7 ? 2 : 0); }

// Rank 0 has all unknowns, and its share of the particles.
std::string memory_line(const Model& model, int ranks) {
  const Real particles = kBytesPerParticle * static_cast<Real>(model.particles.totals.count);
  const Real unknowns =
      kBytesPerUnknown * (3 * static_cast<Real>(model.bodies.size()) + constraint_count(model));
  const std::string most = ranks == 1 ? ""
                                      : fmt::format(" on all ranks together, {} on rank 0",
                                                    megabytes(particles / ranks + unknowns));
  return fmt::format(
      "memory         about {} of state and scratch{} (estimate: {} B per particle, {} B per unknown)\n",
      megabytes(particles + unknowns), most, kBytesPerParticle, kBytesPerUnknown);
}

// Of the GPU that is the fullest, where ranks share GPUs or hosts differ.
std::string device_memory_line(const Model& model, const Ranks& ranks) {
  const std::string line =
      fmt::format("device memory  about {} {} (estimate)", megabytes(static_cast<Real>(device_memory(model))),
                  ranks.alone() ? "on the GPU" : "on the GPU of each rank");
  choose_device(ranks);
  const std::string trouble = device_trouble();
  if (ranks.any(!trouble.empty()))
    return line + "; " + (trouble.empty() ? "another rank cannot use its GPU" : trouble) + "\n";
  const std::vector<DeviceClaim> claims = ranks.gather_everywhere(std::vector{claim_device(model)});
  const auto share = [&](int rank) {
    const DeviceLoad load = load_of_device(claims, rank);
    return static_cast<Real>(load.needed) / static_cast<Real>(std::max<std::size_t>(load.free, 1));
  };
  int fullest = 0;
  for (int rank = 1; rank < ranks.size(); ++rank)
    if (share(rank) > share(fullest)) fullest = rank;
  const DeviceLoad load = load_of_device(claims, fullest);
  const auto device_of = [&](int rank) { return claims[static_cast<std::size_t>(rank)].device; };
  const std::string together = load.ranks == 1
                                   ? ""
                                   : fmt::format(", {} for the {} ranks that share one",
                                                 megabytes(static_cast<Real>(load.needed)), load.ranks);
  return fmt::format("{}{}; {} are free on {}\n", line, together, megabytes(static_cast<Real>(load.free)),
                     device_of(fullest) == device_of(ranks.rank()) ? device_name() : "the fullest GPU");
}

}  // namespace

std::string check_report(const Model& model, const Ranks& ranks) {
  const std::string title = model.title.empty() ? "" : "title          " + printable(model.title) + "\n";
  return title + space_lines(model, ranks.size()) + multibody_lines(model) + limit_lines(model) +
         time_lines(model) + fmt::format("search         skin {:.4g} m\n", model.contact.skin) +
         memory_line(model, ranks.size()) + device_memory_line(model, ranks);
}

}  // namespace scree
