#include "run/check/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/host_memory.hpp"
#include "base/index.hpp"
#include "base/printable.hpp"
#include "dem/backend/device.hpp"
#include "dem/history/packed_history.hpp"
#include "dem/reports/output_fields.hpp"
#include "dem/search/skin_choice.hpp"
#include "model/checks/limits.hpp"
#include "model/checks/memory.hpp"
#include "model/data/body_layout.hpp"
#include "model/derived/choose_law.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/mixture.hpp"
#include "model/derived/touching.hpp"
#include "run/check/check_bodies.hpp"
#include "run/check/check_meshes.hpp"
#include "run/record/joint_lines.hpp"
#include "run/record/stop_conditions.hpp"
#include "run/report/rebound_check.hpp"
#include "run/state/step_clock.hpp"

namespace scree {

namespace {

std::string range(Real smallest, Real largest, const char* unit) {
  if (smallest == largest) return fmt::format("{:.6g} {}", smallest, unit);
  return fmt::format("{:.6g} to {:.6g} {}", smallest, largest, unit);
}

std::string sides_line(const Space& space) {
  std::string sides;
  bool open = false;
  for (int side = 0; side < 2 * space.dimension; ++side) {
    sides += fmt::format("{}{} {}", side == 0 ? "" : ", ", kSideNames[static_cast<std::size_t>(side)],
                         word_of(space.boundary[side]));
    open = open || space.boundary[side] == Boundary::open;
  }
  return fmt::format("sides          {}{}\n", sides,
                     open ? fmt::format("; a particle that leaves: \"{}\"", word_of(space.leaving)) : "");
}

std::string gravity_line(Vec3 gravity) {
  const Real size = norm(gravity);
  if (size == 0) return "gravity        none\n";
  const std::array<Real, 3> parts = {gravity.x, gravity.y, gravity.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(parts[axis]) == size)
      return fmt::format("gravity        {} m/s^2 along {}{}\n", size, parts[axis] < 0 ? '-' : '+',
                         "xyz"[axis]);
  return fmt::format("gravity        {:.6g} m/s^2 along ({:.4g}, {:.4g}, {:.4g})\n", size, gravity.x / size,
                     gravity.y / size, gravity.z / size);
}

// The walls of the deck's list and the sides of the domain that are walls.
std::string walls_text(const Model& model) {
  const std::int64_t sides =
      std::count(model.space.boundary.begin(), model.space.boundary.end(), Boundary::wall);
  const std::int64_t placed = std::ssize(model.walls) - sides;
  if (sides + placed == 0) return "no walls";
  std::vector<std::string> texts;
  if (sides > 0) texts.push_back(counted(sides, "side is a wall", "sides are walls"));
  if (placed > 0) texts.push_back(counted(placed, "wall inside", "walls inside"));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string interval_text(const Inserter& inserter) {
  return inserter.interval == 0 ? "after each step" : fmt::format("every {:.4g} s", inserter.interval);
}

// One line per inserter: its particles, and when they are born.
std::string inserter_lines(const Model& model) {
  std::string lines;
  for (const Inserter& inserter : model.inserters) {
    const Mixture& mixture = *inserter.mixture;
    const Real due = inserter.schedule.due(model.time.end);
    const std::string amount = inserter.amount == Amount::number
                                   ? fmt::format("{:.0f} particles", std::floor(due))
                               : inserter.amount == Amount::mass
                                   ? fmt::format("{:.4g} kg", due)
                                   : fmt::format("{:.4g} m^{} of particles", due, model.space.dimension);
    lines += fmt::format(
        "inserter       \"{}\": {} until time.end, of {:.4g} kg each on average, radius {}; born {}\n",
        inserter.name, amount, mixture.mean_mass(),
        range(mixture.smallest_radius(), mixture.largest_radius(), "m"), interval_text(inserter));
  }
  return lines;
}

std::string outlet_lines(const Model& model) {
  std::string lines;
  for (const Outlet& outlet : model.outlets)
    lines += fmt::format("outlet         \"{}\": removes particles every {:.4g} s from {:g} s on{}\n",
                         outlet.name, outlet.interval, outlet.start,
                         outlet.end < kInfinity ? fmt::format(" until {:g} s", outlet.end) : "");
  return lines;
}

// Groups with different sizes: a distribution that is meant by mass and read by number has other particles.
std::string mean_mass_lines(const std::vector<ParticleGroup>& groups) {
  std::string lines;
  for (const ParticleGroup& group : groups) {
    if (!group.mean_mass) continue;
    const MeanMass& mean = *group.mean_mass;
    const CountedBy other = mean.by == CountedBy::mass ? CountedBy::number : CountedBy::mass;
    lines += fmt::format("sizes          \"{}\": mean mass {:.4g} kg, by {}; by {} it would be {:.4g} kg\n",
                         group.name, mean.mass, word_of(mean.by), word_of(other), mean.of_other_reading);
  }
  return lines;
}

std::string space_lines(const Model& model, int ranks) {
  const Space& space = model.space;
  const auto corner = [&](Vec3 p) {
    return space.dimension == 2 ? fmt::format("({}, {})", p.x, p.y)
                                : fmt::format("({}, {}, {})", p.x, p.y, p.z);
  };
  std::string lines = fmt::format("space          {}D, {} to {} m, {}\n", space.dimension, corner(space.min),
                                  corner(space.max), walls_text(model));
  lines += sides_line(space) + gravity_line(model.gravity);
  const ParticleTotals& particles = model.particles.totals;
  if (particles.count == 0) return lines + "particles      none\n";
  const std::int64_t born = particles.count - particles.at_start;
  lines += fmt::format("particles      {}{}{}, radius {}, mass {}\n", particles.at_start,
                       born == 0 ? "" : fmt::format(" and at most {} of inserters", born),
                       ranks == 1 ? "" : fmt::format(" on {} ranks together", ranks),
                       range(particles.smallest_radius, particles.largest_radius, "m"),
                       range(particles.smallest_mass, particles.largest_mass, "kg"));
  lines += inserter_lines(model) + outlet_lines(model);
  lines += mean_mass_lines(model.particles.groups);
  if (model.disc_thickness.largest == 0) return lines;
  return lines + fmt::format(
                     "thickness      {}, of discs whose mass follows from a density; assumed: 1 m, where "
                     "particles.thickness is left out\n",
                     range(model.disc_thickness.smallest, model.disc_thickness.largest, "m"));
}

// Parameters that a law alone has: "EEPA, plasticity ratio 0.6".
std::string own_text(const AnyParameters& own) {
  std::string text = own->title();
  for (const auto& [name, value] : own->facts()) text += fmt::format(", {} {:g}", name, value);
  return text;
}

// sized: whether the law depends on the partners' sizes.
std::string friction_line(const Friction& friction, const PairLimit& limit, bool sized) {
  return fmt::format("               friction {}, k_t = {:.6g} N/m{}{}\n", friction.friction,
                     limit.slip_stiffness, sized ? " (likewise)" : "",
                     friction.own ? ", " + own_text(friction.own) : "");
}

// Resistance to rolling and twisting of a pair of materials; an empty text without any.
std::string rolling_line(const Model& model, const PairLimit& limit) {
  const RollingParameters rolling = model.contact.rolling_of(limit.material[0], limit.material[1]);
  std::string parts;
  const auto add = [&](const std::string& part) { parts += (parts.empty() ? "" : ", ") + part; };
  if (rolling.friction > 0)
    add(fmt::format("rolling friction {}, k_r / R^2 = {:.6g} N/m (smallest partners{})", rolling.friction,
                    limit.rolling_stiffness, limit.law.exponent == 1 ? "" : ", at 1 % overlap"));
  if (rolling.damping > 0) add(fmt::format("C_r = {:.6g} N m s", rolling.damping));
  if (rolling.twisting_friction > 0) add(fmt::format("twisting friction {}", rolling.twisting_friction));
  if (rolling.own) add(own_text(rolling.own));
  return parts.empty() ? "" : fmt::format("               {}\n", parts);
}

// Adhesion of a pair of materials and parameters of its normal law alone; an empty text without any.
std::string attraction_line(const Model& model, const PairLimit& limit) {
  const NormalLawParameters& law = model.contact.law(limit.material[0], limit.material[1]);
  std::string parts = own_text(law.own);
  const auto add = [&](const std::string& part) { parts += (parts.empty() ? "" : ", ") + part; };
  if (law.adhesion_work > 0 && !law.own) add(law.jkr ? "JKR" : "DMT");
  if (law.adhesion_work > 0) add(fmt::format("work of adhesion {:.6g} J/m^2", law.adhesion_work));
  if (law.attraction > 0) add(fmt::format("attraction {:.6g} N", law.attraction));
  if (limit.sticking_speed > 0)
    add(fmt::format("undamped impacts of the smallest partners stick below {:.4g} m/s",
                    limit.sticking_speed));
  const Real reach = largest_interaction_range(law, radius_range(model).largest);
  if (reach > 0) parts += fmt::format(", contacts act up to a gap of {:.4g} m", reach);
  return parts.empty() ? "" : fmt::format("               {}\n", parts);
}

using MaterialPair = std::pair<int, int>;
template <class Of>
MaterialPair pair_of(const Of& of) {
  return {of.material[0], of.material[1]};
}

std::string limit_lines(const Model& model, const std::vector<StepTrial>& trials) {
  std::string lines;
  const std::vector<std::string>& names = model.contact.material_names;
  std::map<MaterialPair, const StepTrial*> trial_of;
  for (const StepTrial& trial : trials) trial_of[pair_of(trial.limit)] = &trial;
  std::map<MaterialPair, const CombinedPair*> made;  // mixed pairs, which the deck does not give
  for (const CombinedPair& pair : model.contact.combined) made[pair_of(pair)] = &pair;
  for (const PairLimit& limit : pair_limits(model)) {
    const NormalLawParameters& law = limit.law;
    const bool sized = model.contact.law(limit.material[0], limit.material[1]).depends_on_size();
    lines += fmt::format("contact        \"{}\" on \"{}\": K = {:.6g} N/m{}, C = {:.6g} N s/m{}, {}\n",
                         names[as_size(limit.material[0])], names[as_size(limit.material[1])],
                         law.normal_stiffness, law.exponent == 1 ? "" : fmt::format("^{}", law.exponent),
                         law.normal_damping,
                         !sized              ? ""
                         : law.exponent == 1 ? " (smallest partners)"
                                             : " (smallest partners, at 1 % overlap)",
                         law.tension || model.contact.law(limit.material[0], limit.material[1]).is_cohesive()
                             ? "tensile force allowed"
                             : "no tensile force");
    if (const auto pair = made.find(pair_of(limit)); pair != made.end())
      lines += fmt::format("               from contact.mixing: {}\n", pair->second->keys);
    if (limit.slip_stiffness > 0)
      lines += friction_line(model.contact.friction_of(limit.material[0], limit.material[1]), limit, sized);
    lines += rolling_line(model, limit) + attraction_line(model, limit);
    lines += fmt::format("               shortest contact {:.4g} s{}\n", limit.contact_time,
                         law.exponent == 1 ? "" : " (at 1 % overlap)");
    if (const auto trial = trial_of.find(pair_of(limit)); trial != trial_of.end())
      lines += rebound_lines(*trial->second);
    if (limit.explicit_step > 0) {
      lines += fmt::format("               velocity-verlet in dense contact: steps up to {:.4g} s\n",
                           limit.explicit_step);
    }
  }
  return lines;
}

// The number of adaptive steps: from the number without any contact to the number with permanent contact.
std::string adaptive_steps(const Model& model, const std::vector<StepTrial>& trials) {
  const TimeControl& time = model.time;
  Real shortest = time.max_step;
  for (const StepTrial& trial : trials) shortest = std::min(shortest, trial.step);
  const auto steps_of = [&](Real step) { return std::ceil(time.end / step * (1 - 1e-9)); };
  const std::string fewest = fmt::format("{:.0f} steps", steps_of(time.max_step));
  if (shortest == time.max_step) return fewest + ", more if the motion of the bodies requires shorter ones";
  return fmt::format("{} without any contact, about {:.0f} of {:.2g} s with contacts at all times", fewest,
                     std::stod(fmt::format("{:.1e}", steps_of(shortest))), shortest);
}

std::string fixed_steps(const Model& model) {
  const std::int64_t steps = steps_of_fixed(model), substeps = model.integrator.substeps;
  return substeps == 1 ? counted(steps, "step", "steps")
                       : fmt::format("{}, of {} substeps each: {}", counted(steps, "step", "steps"), substeps,
                                     steps * substeps);
}

// A line with the reason for a chosen value; empty for a value that the deck names.
std::string chosen_line(const std::vector<ChosenValue>& chosen, const std::string& key) {
  const auto found = std::ranges::find(chosen, key, &ChosenValue::key);
  return found == chosen.end() || found->reason.empty()
             ? ""
             : fmt::format("               chosen: {}\n", found->reason);
}

std::string time_lines(const Model& model, const std::vector<StepTrial>& trials,
                       const std::vector<ChosenValue>& chosen) {
  const TimeControl& time = model.time;
  const Integrator& integrator = model.integrator;
  const bool fixed = time.control == StepControl::fixed;
  std::string lines = fmt::format("time           0 to {} s, ", time.end);
  lines += fixed
               ? fmt::format("fixed step {} s ({})\n", time.step, fixed_steps(model))
               : fmt::format(
                     "adaptive steps from {:.4g} to {:.4g} s, the first of {:.4g} s, tolerance {}\n"
                     "               {}\n",
                     time.min_step, time.max_step, time.step, time.tolerance, adaptive_steps(model, trials));
  lines += chosen_line(chosen, "step");
  const std::string particles =
      integrator.particles == ParticleIntegrator::hht
          ? "HHT, too"
          : word_of(integrator.particles) + ", " + counted(integrator.substeps, "substep", "substeps");
  return lines +
         fmt::format("integrator     bodies HHT with alpha = {}; particles {}\n", integrator.hht_alpha,
                     particles) +
         chosen_line(chosen, "particles");
}

// A line for each stop condition.
std::string stop_lines(const Model& model) {
  check_stop_columns(model);
  std::string lines;
  for (const StopCondition& condition : model.stop_conditions)
    lines += fmt::format("stop           \"{}\": {}\n", printable(condition.name), described(condition));
  return lines;
}

std::string megabytes(Real bytes) {
  if (bytes < 1e5) return fmt::format("{:.{}f} kB", bytes / 1e3, bytes < 1e4 ? 1 : 0);
  return fmt::format("{:.{}f} MB", bytes / 1e6, bytes < 1e7 ? 2 : 0);
}

// Memory on the host: rank 0 holds all unknowns, and its share of the particles.
std::string memory_line(const Model& model, int ranks) {
  const Real per_particle = bytes_per_particle(model) + history_bytes_with_pairs(history_of(model.contact));
  const Real particles = per_particle * static_cast<Real>(model.particles.totals.count);
  const Real unknowns =
      kBytesPerUnknown * static_cast<Real>(BodyLayout(model.bodies).columns() + constraint_count(model));
  const ModelSize size = size_of(model);
  const Real meshes = bytes_of_meshes(model, false), surfaces = meshes + bytes_of_shapes(size),
             of_root =
                 unknowns + bytes_of_meshes(model, true) - meshes;  // in addition to what every rank holds
  const std::string most = ranks == 1 ? ""
                                      : fmt::format(" on all ranks together, {} on rank 0",
                                                    megabytes(particles / ranks + of_root + surfaces));
  const FreeMemory free = free_memory();
  const MemoryBound& bound = free.process.bytes < free.host.bytes ? free.process : free.host;
  return fmt::format(
      "memory         about {} of state and scratch{} (estimate: {} B per particle, {} B per unknown{}{}); "
      "{} are free here ({})\n",
      megabytes(particles + of_root + ranks * surfaces), most, per_particle, kBytesPerUnknown,
      size.shapes == 0 ? "" : fmt::format(", {} B per shape on every rank", kBytesPerShape),
      meshes == 0 ? "" : fmt::format(", {} B per triangle on every rank", bytes_per_triangle(model)),
      megabytes(bound.bytes), bound.set_by);
}

// Whether the host has room for the estimate of device memory, which counts neighbours and images if radii
// differ or sides are periodic.
bool can_estimate_device(const Model& model, const Ranks& ranks) {
  constexpr Real kToEstimate = 325;  // measured [B]
  const FreeMemory free = free_memory();
  const Real bytes = kToEstimate * static_cast<Real>(model.particles.size()),
             together = ranks.sum_on_host(bytes);
  return !ranks.any(bytes > free.process.bytes || together > free.host.bytes);
}

std::string skin_line(const Model& model) {
  const Real skin = model.contact.skin;
  if (!chooses_skin(model))
    return fmt::format("search         skin {:.4g} m{}\n", skin,
                       model.contact.skin_is_default ? ", the default" : "");
  const auto [smallest, largest] = skins_to_choose_from(model);
  return fmt::format("search         skin {:.4g} m at the start, then chosen between {:.3g} and {:.3g} m\n",
                     skin, smallest, largest);
}

// Device memory. If ranks share GPUs or hosts differ, free memory is that of the GPU with the largest needed
// share.
std::string device_memory_line(const Model& model, const Ranks& ranks) {
  if (!can_estimate_device(model, ranks))
    return "device memory  not estimated: this host has too little free memory for the estimate\n";
  const std::size_t meshes = device_memory_of_meshes(model);
  const std::string line = fmt::format(
      "device memory  about {} {} (estimate{})", megabytes(static_cast<Real>(device_memory(model))),
      ranks.alone() ? "on the GPU" : "on each rank's GPU",
      meshes == 0 ? ""
                  : fmt::format("; {} of it meshes; each particle that comes near one {} B more",
                                megabytes(static_cast<Real>(meshes)), device_memory_near_mesh(model)));
  choose_device(ranks);
  const std::string trouble = device_error();
  if (ranks.any(!trouble.empty()))
    return line + "; " + (trouble.empty() ? "another rank cannot use its GPU" : trouble) + "\n";
  const std::vector<DeviceClaim> claims = ranks.all_gather(std::vector{claim_device(model)});
  const auto share = [&](int rank) {
    const DeviceLoad load = load_of_device(claims, rank);
    return static_cast<Real>(load.needed) / static_cast<Real>(std::max<std::size_t>(load.free, 1));
  };
  int fullest = 0;
  for (int rank = 1; rank < ranks.size(); ++rank)
    if (share(rank) > share(fullest)) fullest = rank;
  const DeviceLoad load = load_of_device(claims, fullest);
  const auto device_of = [&](int rank) { return claims[as_size(rank)].device; };
  const std::string together = load.ranks == 1
                                   ? ""
                                   : fmt::format(", {} for the {} ranks that share one GPU",
                                                 megabytes(static_cast<Real>(load.needed)), load.ranks);
  return fmt::format("{}{}; {} are free on {}\n", line, together, megabytes(static_cast<Real>(load.free)),
                     device_of(fullest) == device_of(ranks.rank()) ? device_name() : "the fullest GPU");
}

}  // namespace

std::string check_report(const Model& model, const std::vector<ChosenValue>& chosen, const Ranks& ranks,
                         const std::string& files) {
  const std::vector<StepTrial> trials = try_steps(model);
  const std::string title = model.title.empty() ? "" : "title          " + printable(model.title) + "\n";
  return title + space_lines(model, ranks.size()) + mesh_lines(model) + multibody_lines(model) +
         limit_lines(model, trials) + time_lines(model, trials, chosen) + stop_lines(model) + files +
         history_limit_lines(model) + skin_line(model) + memory_line(model, ranks.size()) +
         device_memory_line(model, ranks);
}

}  // namespace scree
