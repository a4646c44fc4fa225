#include "run/record/history_columns.hpp"

#include <utility>

#include "base/index.hpp"
#include "model/derived/joint_coordinates.hpp"

namespace scree {
namespace {

using Sample = HistorySample;

// Adds the columns of one group of datasets.
class Group {
 public:
  Group(std::string name, std::vector<RecordedColumn>& out) : name_(std::move(name)), out_(out) {}

  void add(const std::string& name, const char* unit, const std::string& text,
           std::function<Real(const Sample&)> value) {
    out_.push_back({{name_, name, unit, text}, std::move(value)});
  }
  // PREFIXx, PREFIXy, PREFIXz
  void add_vector(const std::string& prefix, const char* unit, const std::string& text,
                  const std::function<Vec3(const Sample&)>& value) {
    add(prefix + "x", unit, text, [value](const Sample& s) { return value(s).x; });
    add(prefix + "y", unit, text, [value](const Sample& s) { return value(s).y; });
    add(prefix + "z", unit, text, [value](const Sample& s) { return value(s).z; });
  }
  void add_count(const char* name, const char* text,
                 const std::function<std::int64_t(const Sample&)>& value) {
    add(name, "1", text, [value](const Sample& s) { return static_cast<Real>(value(s)); });
  }

 private:
  std::string name_;
  std::vector<RecordedColumn>& out_;
};

void step_columns(Group step) {
  step.add("time", "s", "simulated time", [](const Sample& s) { return s.time; });
  step.add("length", "s", "length of the last step", [](const Sample& s) { return s.step; });
  step.add_count("steps", "accepted steps so far", [](const Sample& s) { return s.counts.steps; });
  step.add_count("newton_iterations", "Newton iterations so far",
                 [](const Sample& s) { return s.counts.newton_iterations; });
  step.add_count("linear_iterations", "iterations of the particles' linear solve so far",
                 [](const Sample& s) { return s.counts.linear_iterations; });
  step.add_count("rejected_error", "steps rejected so far for their local error",
                 [](const Sample& s) { return s.counts.rejected_error; });
  step.add_count("rejected_newton", "steps rejected so far because they did not converge",
                 [](const Sample& s) { return s.counts.rejected_newton; });
  step.add_count("contacts", "contacts, including those with walls and body shapes",
                 [](const Sample& s) { return s.particles.contacts; });
  step.add_count("particles_escaped", "particles that have left the domain so far",
                 [](const Sample& s) { return s.left; });
  step.add_count("bodies_outside", "bodies whose centre is outside the space",
                 [](const Sample& s) { return s.bodies_outside; });
}

void particle_counts(Group step) {
  step.add_count("particles", "particles in the run: those at t = 0 and born so far, less removed ones",
                 [](const Sample& s) { return s.population.particles; });
  step.add("born_mass", "kg", "mass of the particles born so far",
           [](const Sample& s) { return s.population.born_mass; });
}

// k: index of the outlet.
void outlet_columns(Group outlet, std::size_t k) {
  outlet.add_count("removed", "particles removed so far",
                   [k](const Sample& s) { return s.population.removed[k]; });
  outlet.add("mass", "kg", "mass of the particles removed so far",
             [k](const Sample& s) { return s.population.removed_mass[k]; });
}

// i: index of the inserter.
void inserter_columns(Group inserter, std::size_t i) {
  inserter.add_count("born", "particles born so far", [i](const Sample& s) { return s.population.born[i]; });
  inserter.add_count("waiting", "particles that are due and wait for a free position",
                     [i](const Sample& s) { return s.population.waiting[i]; });
  inserter.add_count("dropped", "particles left out so far because no position was free",
                     [i](const Sample& s) { return s.population.dropped[i]; });
}

void energy_columns(Group energy, bool has_births) {
  const auto entry = [&](const char* name, const char* text, Real Ledger::*value) {
    energy.add(name, "J", text, [value](const Sample& s) { return s.ledger.*value; });
  };
  entry("kinetic", "kinetic energy of particles and bodies", &Ledger::kinetic);
  entry("gravitational", "gravitational energy, zero at the origin", &Ledger::gravitational);
  entry("elastic_force_elements", "elastic energy of force elements", &Ledger::elastic_force_elements);
  entry("elastic_contacts",
        "elastic energy of contacts, zero outside the interaction range: of normal forces (negative where "
        "they are adhesive) and of the springs of friction, rolling and twisting",
        &Ledger::elastic_contacts);
  entry("dissipated_force_elements", "energy dissipated in force elements since t = 0",
        &Ledger::dissipated_force_elements);
  entry("dissipated_contacts", "energy dissipated in contacts since t = 0", &Ledger::dissipated_contacts);
  entry("dissipated_integrator", "energy taken out by the time integration since t = 0",
        &Ledger::dissipated_integrator);
  entry("driver_work", "work of drivers, actuators, applied forces and walls since t = 0",
        &Ledger::driver_work);
  entry("carried_out",
        "kinetic and gravitational energy of removed particles, and elastic energy of contacts that ended "
        "when a particle escaped or was removed",
        &Ledger::carried_out);
  if (has_births)
    entry("carried_in", "kinetic and gravitational energy of the particles born so far, at birth",
          &Ledger::carried_in);
  energy.add("total", "J", "kinetic, gravitational and elastic energy",
             [](const Sample& s) { return s.ledger.mechanical(); });
  energy.add("balance_error", "J",
             "total + dissipated + carried out - driver work - carried in, less its value at t = 0, without "
             "particles outside the domain; with velocity-Verlet this is the effect of its steps on contacts",
             [](const Sample& s) { return s.balance_error; });
  energy.add(
      "exchanged", "J",
      "largest kinetic energy of particles, plus the ranges of the kinetic energy of bodies, the elastic "
      "energy of force elements and the driver work, plus the energy dissipated, since t = 0",
      [](const Sample& s) { return s.exchanged; });
}

// Columns with parts of the energies in energy_columns().
void cohesion_columns(Group energy) {
  energy.add(
      "elastic_cohesion", "J",
      "energy/elastic_contacts less the elastic energy of the same overlaps without adhesion: negative in "
      "cohesive contacts",
      [](const Sample& s) { return s.particles.cohesion; });
}

void rotation_columns(Group rotation, bool rolls) {
  const auto part = [&](const char* name, const char* text, Real RotationEnergies::*value) {
    rotation.add(name, "J", text, [value](const Sample& s) { return s.particles.rotation.*value; });
  };
  part("kinetic", "kinetic energy of the particles' rotation: a part of energy/kinetic",
       &RotationEnergies::kinetic);
  part("elastic_friction",
       "elastic energy of the tangential springs of contacts: a part of energy/elastic_contacts",
       &RotationEnergies::friction_springs);
  part("elastic_rolling",
       "elastic energy of the rolling and twisting springs of contacts: a part of energy/elastic_contacts",
       &RotationEnergies::rolling_springs);
  const auto loss = [&](const char* name, const std::string& of, LossKind kind, unsigned parts) {
    if (!FieldsThere{true, rolls}.has(parts)) return;
    rotation.add(name, "J",
                 "energy dissipated by " + of + " since t = 0: a part of energy/dissipated_contacts",
                 [kind](const Sample& s) { return s.losses.of[kind]; });
  };
#define SCREE_LOSS_COLUMN(of, kind, field, column, what, parts) loss(#column, what, kind, parts);
  SCREE_LOSS_KINDS(SCREE_LOSS_COLUMN, )
#undef SCREE_LOSS_COLUMN
}

void momentum_columns(Group momentum) {
  momentum.add_vector("linear_", "kg m/s", "momentum of the particles",
                      [](const Sample& s) { return s.particles.momentum; });
  momentum.add_vector("angular_", "kg m^2/s",
                      "angular momentum of the particles about the origin, including their spin",
                      [](const Sample& s) { return s.particles.angular_momentum; });
}

// k: index of the reaction.
void reaction_columns(Group joint, BodyKind kind, std::size_t k) {
  const char* text = "reaction on the joint's second body at its joint point";
  if (kind == BodyKind::spatial) {
    joint.add_vector("f", "N", text, [k](const Sample& s) { return s.reactions[k].force; });
    joint.add_vector("torque_", "N m", "reaction torque on the joint's second body about its joint point",
                     [k](const Sample& s) { return s.reactions[k].torque; });
    const auto in_frame = [k](const Sample& s, Vec3 Reaction::*load) {
      return rotated(conjugate(s.reactions[k].frame), s.reactions[k].*load);
    };
    joint.add_vector("marker_f", "N", "reaction in the axes of the joint's first marker",
                     [in_frame](const Sample& s) { return in_frame(s, &Reaction::force); });
    joint.add_vector("marker_torque_", "N m", "reaction torque in the axes of the joint's first marker",
                     [in_frame](const Sample& s) { return in_frame(s, &Reaction::torque); });
    return;
  }
  joint.add("fx", "N", text, [k](const Sample& s) { return s.reactions[k].force.x; });
  joint.add("fy", "N", text, [k](const Sample& s) { return s.reactions[k].force.y; });
  joint.add("torque", "N m", "reaction torque on the joint's second body",
            [k](const Sample& s) { return s.reactions[k].torque.z; });
}

// k: index of the bushing.
void bushing_columns(Group bushing, std::size_t k) {
  const std::string along = ", in the bushing's axes on the first body";
  bushing.add_vector("", "m", "displacement of the second body's point" + along,
                     [k](const Sample& s) { return s.bushings[k].shift; });
  bushing.add_vector("turn_", "rad", "rotation vector of the second body's frame" + along,
                     [k](const Sample& s) { return s.bushings[k].turn; });
  bushing.add_vector("f", "N", "force on the second body" + along,
                     [k](const Sample& s) { return s.bushings[k].force; });
  bushing.add_vector("torque_", "N m", "torque on the second body about its point" + along,
                     [k](const Sample& s) { return s.bushings[k].torque; });
}

// k: index of the effort.
void effort_columns(Group effort, bool is_angle, std::size_t k) {
  effort.add("coordinate", is_angle ? "rad" : "m", "coordinate of the joint",
             [k](const Sample& s) { return s.efforts[k].coordinate; });
  effort.add("rate", is_angle ? "rad/s" : "m/s", "rate of the coordinate",
             [k](const Sample& s) { return s.efforts[k].rate; });
  effort.add("effort", is_angle ? "N m" : "N",
             "effort (generalized force) in the direction of the coordinate",
             [k](const Sample& s) { return s.efforts[k].effort; });
  effort.add("power", "W", "effort times rate", [k](const Sample& s) { return s.efforts[k].power; });
}

const char* coordinate_text(JointCoordinate coordinate) {
  switch (coordinate) {
    case JointCoordinate::angle:
      return "angle of the joint's second body less that of the first";
    case JointCoordinate::displacement:
      return "displacement along the joint's axis";
    case JointCoordinate::length:
      return "distance of the joint's two points";
    case JointCoordinate::angle_1:
      return "angle of the joint's cross against the first body, about that body's arm";
    case JointCoordinate::angle_2:
      return "angle of the joint's second body against the cross, about the second body's arm";
  }
  return "";
}

// k: index of the coordinate.
void coordinate_columns(Group joint, JointCoordinate coordinate, std::size_t k) {
  const bool angle = is_angle(coordinate);
  const std::string name = word_of(coordinate);
  joint.add(name, angle ? "rad" : "m", coordinate_text(coordinate),
            [k](const Sample& s) { return s.coordinates[k].value; });
  joint.add(name + "_rate", angle ? "rad/s" : "m/s", "rate of the coordinate",
            [k](const Sample& s) { return s.coordinates[k].rate; });
}

std::string torque_text(const ContactTarget& target) {
  if (target.wall >= 0)
    return "torque of these forces about the wall's point, for a mesh its origin, which moves with the wall";
  return target.row ? "torque of these forces about the origin"
                    : "torque of these forces about the body's centre";
}

// k: index of the target.
void contact_columns(Group contacts, const ContactTarget& target, std::size_t k) {
  const std::string what = target.wall >= 0   ? "the wall"
                           : target.mesh >= 0 ? "the mesh"
                           : target.row       ? "the row's bodies"
                                              : "the body";
  contacts.add_vector("f", "N", "contact force on " + what,
                      [k](const Sample& s) { return s.contacts[k].force; });
  contacts.add_vector("torque_", "N m", torque_text(target),
                      [k](const Sample& s) { return s.contacts[k].torque; });
  contacts.add("contacts", "1",
               "contacts of " + what + " with particles, bodies" + (target.wall >= 0 ? "" : " and walls"),
               [k](const Sample& s) { return static_cast<Real>(s.contacts[k].contacts); });
}

// k: index of the region.
void region_columns(Group region, std::size_t k) {
  region.add("number", "1", "particles whose centres are in the region",
             [k](const Sample& s) { return s.regions[k].number; });
  region.add("mass", "kg", "mass of these particles", [k](const Sample& s) { return s.regions[k].mass; });
}

void spatial_columns(Group body, std::size_t b) {
  const auto part = [&](const char* name, Real Quaternion::*value) {
    body.add(name, "1",
             "orientation, a unit quaternion of continuous sign from the body's frame, scalar first",
             [b, value](const Sample& s) { return s.bodies[b].orientation.*value; });
  };
  part("e0", &Quaternion::w);
  part("e1", &Quaternion::x);
  part("e2", &Quaternion::y);
  part("e3", &Quaternion::z);
  body.add_vector("w", "rad/s", "angular velocity in the body's frame",
                  [b](const Sample& s) { return s.bodies[b].spin; });
}

// center: of mass, in the body's frame [m].
void origin_columns(Group body, Vec3 center, std::size_t b) {
  const auto origin = [b, center](const Sample& s) { return point_motion(s.bodies[b], -center); };
  body.add_vector("origin_", "m", "position of the origin of the body's frame",
                  [origin](const Sample& s) { return origin(s).position; });
  body.add_vector("origin_v", "m/s", "velocity of the origin of the body's frame",
                  [origin](const Sample& s) { return origin(s).velocity; });
}

void body_columns(Group body, const Body& of, std::size_t b) {
  body.add_vector("", "m", "position of the centre of mass",
                  [b](const Sample& s) { return s.bodies[b].position; });
  body.add_vector("v", "m/s", "velocity of the centre of mass",
                  [b](const Sample& s) { return s.bodies[b].velocity; });
  if (!(of.center_of_mass == Vec3{})) origin_columns(body, of.center_of_mass, b);
  if (of.kind == BodyKind::spatial) return spatial_columns(body, b);
  body.add("angle", "rad", "angle about z", [b](const Sample& s) { return s.bodies[b].angle; });
  body.add("angular_velocity", "rad/s", "angular velocity about z",
           [b](const Sample& s) { return s.bodies[b].angular_velocity; });
}

// k: index of the particle among the traced ones.
void particle_columns(Group particle, bool rotates, std::size_t k) {
  particle.add_vector("", "m", "position", [k](const Sample& s) { return s.traced[k].position; });
  particle.add_vector("v", "m/s", "velocity", [k](const Sample& s) { return s.traced[k].velocity; });
  if (rotates)
    particle.add_vector("w", "rad/s", "angular velocity in the global axes",
                        [k](const Sample& s) { return s.traced[k].angular_velocity; });
}

}  // namespace

PopulationSample population_sample(const Model& model, const State& state) {
  const PopulationState& population = state.population;
  PopulationSample sample;
  for (int i = 0; i < std::ssize(population.due); ++i) {
    sample.born.push_back(population.born_of(i)), sample.waiting.push_back(population.waiting_of(i));
    sample.dropped.push_back(population.dropped[as_size(i)]);
  }
  for (int k = 0; k < std::ssize(state.outlets.removed); ++k) {
    sample.removed.push_back(state.outlets.removed[as_size(k)]);
    sample.removed_mass.push_back(state.outlets.mass_of(k));
  }
  sample.particles = particles_so_far(model.particles, population) - state.carried_out.removed;
  sample.born_mass = population.born_mass();
  return sample;
}

std::vector<RecordedColumn> history_columns(const Model& model, const std::vector<Reaction>& reactions,
                                            const std::vector<JointEffortSample>& efforts,
                                            const std::vector<JointReading>& coordinates,
                                            const std::vector<BushingSample>& bushings) {
  std::vector<RecordedColumn> out;
  const Output& output = model.output;
  const bool has_births = !model.inserters.empty();
  step_columns({"step", out});
  if (has_births || !model.outlets.empty()) particle_counts({"step", out});
  energy_columns({"energy", out}, has_births);
  if (model.is_cohesive()) cohesion_columns({"energy", out});
  if (model.rotates()) rotation_columns({"rotation", out}, model.rolls());
  momentum_columns({"momentum", out});
  for (std::size_t k = 0; k < reactions.size(); ++k)
    reaction_columns({"reactions/" + reactions[k].joint, out}, reactions[k].kind, k);
  for (std::size_t k = 0; k < efforts.size(); ++k)
    effort_columns({"efforts/" + efforts[k].name, out}, efforts[k].is_angle, k);
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    coordinate_columns({"coordinates/" + coordinates[k].joint, out}, coordinates[k].coordinate, k);
  for (std::size_t k = 0; k < bushings.size(); ++k) bushing_columns({"bushings/" + bushings[k].name, out}, k);
  for (std::size_t k = 0; k < output.history_contacts.size(); ++k)
    contact_columns({"contacts/" + output.history_contacts[k].name, out}, output.history_contacts[k], k);
  for (std::size_t i = 0; i < model.inserters.size(); ++i)
    inserter_columns({"inserters/" + model.inserters[i].name, out}, i);
  for (std::size_t k = 0; k < model.outlets.size(); ++k)
    outlet_columns({"outlets/" + model.outlets[k].name, out}, k);
  for (std::size_t k = 0; k < output.history_regions.size(); ++k)
    region_columns({"regions/" + output.history_regions[k].name, out}, k);
  for (const int body : output.history_bodies) {
    const auto b = as_size(body);
    body_columns({"bodies/" + model.bodies[b].name, out}, model.bodies[b], b);
  }
  for (std::size_t k = 0; k < output.history_particles.size(); ++k)
    particle_columns({"particles/" + std::to_string(output.history_particles[k]), out}, model.rotates(), k);
  return out;
}

}  // namespace scree
