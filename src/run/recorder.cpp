#include "run/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "partition/id_order.hpp"
#include "run/bodies_outside.hpp"
#include "run/contact_columns.hpp"

namespace scree {
namespace {

using Columns = std::vector<HistoryColumn>;

void step_columns(Columns& out) {
  const auto add = [&](const char* name, const char* unit, const char* text) {
    out.push_back({"step", name, unit, text});
  };
  add("time", "s", "simulated time");
  add("length", "s", "length of the last step");
  add("steps", "1", "accepted steps so far");
  add("newton_iterations", "1", "Newton iterations so far");
  add("linear_iterations", "1", "iterations of the particles' linear solve so far");
  add("rejected_error", "1", "steps rejected for their local error so far");
  add("rejected_newton", "1", "steps rejected for want of convergence so far");
  add("contacts", "1", "touching pairs, walls and body shapes included");
  add("left", "1", "particles that have left the space so far");
  add("bodies_outside", "1", "bodies whose centre is outside the space");
}

void energy_columns(Columns& out) {
  const auto add = [&](const char* name, const char* text) { out.push_back({"energy", name, "J", text}); };
  add("kinetic", "kinetic energy of particles and bodies");
  add("gravitational", "gravitational energy, zero at the origin");
  add("elastic_force_elements", "elastic energy of force elements");
  add("elastic_contacts", "elastic energy of contacts");
  add("dissipated_force_elements", "dissipated in force elements since t = 0");
  add("dissipated_contacts", "dissipated in contacts since t = 0");
  add("dissipated_integrator", "taken out by the time integration since t = 0");
  add("driver_work", "work of drivers, actuators and applied forces since t = 0");
  add("carried_out",
      "kinetic and gravitational energy of removed particles, and elastic energy of contacts that ended as a "
      "particle left");
  add("total", "kinetic, gravitational and elastic energy");
  add("balance_error",
      "total + dissipated + carried out - driver work, less its value at t = 0; with velocity-Verlet what "
      "its steps did to contacts");
  add("exchanged", "energy that changed its place since t = 0, from row to row");
}

void momentum_columns(Columns& out) {
  for (const char* axis : {"x", "y", "z"})
    out.push_back({"momentum", std::string("linear_") + axis, "kg m/s", "momentum of the particles"});
  for (const char* axis : {"x", "y", "z"})
    out.push_back({"momentum", std::string("angular_") + axis, "kg m^2/s",
                   "angular momentum of the particles about the origin"});
}

void motion_columns(Columns& out, const std::string& group, bool body) {
  for (const char* axis : {"x", "y", "z"}) out.push_back({group, axis, "m", "position"});
  for (const char* axis : {"x", "y", "z"}) out.push_back({group, std::string("v") + axis, "m/s", "velocity"});
  if (!body) return;
  out.push_back({group, "angle", "rad", "angle about z"});
  out.push_back({group, "angular_velocity", "rad/s", "angular velocity about z"});
}

Columns history_columns(const Model& model, const std::vector<Reaction>& reactions) {
  Columns out;
  step_columns(out);
  energy_columns(out);
  momentum_columns(out);
  for (const Reaction& reaction : reactions) {
    const std::string group = "reactions/" + reaction.joint;
    out.push_back({group, "fx", "N", "reaction on the joint's second body at its joint point"});
    out.push_back({group, "fy", "N", "reaction on the joint's second body at its joint point"});
    out.push_back({group, "torque", "N m", "reaction torque on the joint's second body"});
  }
  add_contact_columns(model, out);
  for (const int body : model.output.history_bodies)
    motion_columns(out, "bodies/" + model.bodies[body].name, true);
  for (const GlobalId id : model.output.history_particles)
    motion_columns(out, "particles/" + std::to_string(id), false);
  return out;
}

// The ones that the deck wants recorded.
std::vector<Reaction> reactions_of(const Model& model, const BodyLink& link, const State& state) {
  if (link.multibody() == nullptr || model.output.history_reactions == 0) return {};
  std::vector<Reaction> reactions = link.multibody()->reactions(state.bodies, state.clock.time);
  const auto wanted = static_cast<std::size_t>(model.output.history_reactions);
  if (reactions.size() > wanted) reactions.resize(wanted);
  return reactions;
}

void append(std::vector<Real>& row, Vec3 v) { row.insert(row.end(), {v.x, v.y, v.z}); }

// A particle whose motion is recorded.
struct Traced {
  GlobalId global_id;
  Vec3 position, velocity;
};

std::vector<Traced> traced_of(const ParticlePack& pack, const std::vector<GlobalId>& wanted) {
  std::vector<Traced> traced;
  for (const GlobalId id : wanted) {
    const auto found = std::find(pack.global_id.begin(), pack.global_id.end(), id);
    if (found == pack.global_id.end()) continue;
    const auto i = static_cast<std::size_t>(found - pack.global_id.begin());
    traced.push_back({id, pack.position[i], pack.velocity[i]});
  }
  return traced;
}

// The part of all ranks' particles that this rank writes.
ParticlePack in_id_order(const Ranks& ranks, std::int64_t particles, ParticlePack p) {
  const IdOrder order(ranks, particles, p.global_id);
  p.global_id = order.apply(std::move(p.global_id)), p.radius = order.apply(std::move(p.radius));
  p.position = order.apply(std::move(p.position)), p.velocity = order.apply(std::move(p.velocity));
  p.force = order.apply(std::move(p.force)), p.contacts = order.apply(std::move(p.contacts));
  return p;
}

}  // namespace

Recorder::Recorder(const Model& model, Backend& backend, const BodyLink& link, const std::string& directory,
                   const State& state)
    : model_(model), backend_(backend), link_(link) {
  link.ranks().on_root([&] {
    history_.emplace(directory, history_columns(model, reactions_of(model, link, state)),
                     model.output.history_csv, state.history_rows);
  });
  snapshots_.emplace(directory, SeriesOptions{model.title, static_cast<int>(state.snapshots),
                                              model.output.compression, link.ranks()});
  if (writes_late()) backend.set_idle_work([this] { write_pending(); });
}

// Several ranks write together, and they do not wait for their devices at the same time.
bool Recorder::writes_late() const { return backend_.computes_asynchronously() && link_.ranks().alone(); }

Recorder::~Recorder() { backend_.set_idle_work({}); }

void Recorder::history(State& state, Real h) {
  const auto real = [](std::int64_t n) { return static_cast<Real>(n); };
  const StepCounts& n = state.counts;
  std::vector<Real> row{state.clock.time,
                        h,
                        real(n.steps),
                        real(n.newton_iterations),
                        real(n.linear_iterations),
                        real(n.rejected_error),
                        real(n.rejected_newton)};
  energy_row(state, row);
  reaction_row(state, row);
  add_contact_values(model_, link_, state, backend_, row);
  body_row(state, row);
  particle_row(row);
  if (history_) history_->append(row);
  ++state.history_rows;
}

void Recorder::rebase_balance(State& state) {
  BalanceState& balance = state.balance;
  if (!balance.open) return;
  const Ledger now = make_ledger(backend_.ledger(verlet_step(model_)), state.carried_out, link_.multibody(),
                                 state.bodies, state.clock.time);
  balance.start += now.accounted() - balance.last.accounted();
  balance.last = now;
}

void Recorder::energy_row(State& state, std::vector<Real>& row) {
  const ParticleLedger particles = backend_.ledger(verlet_step(model_));
  const Ledger ledger =
      make_ledger(particles, state.carried_out, link_.multibody(), state.bodies, state.clock.time);
  BalanceState& balance = state.balance;
  // Not yet at the start: the first step can tell more.
  if (balance.open && link_.ranks().any(!std::isfinite(ledger.mechanical())))
    throw SimulationError("stage output: the energy of particles and bodies is not finite");
  if (!balance.open) balance = {true, ledger.accounted(), 0, ledger};
  balance.exchanged += energy_exchanged(balance.last, ledger);
  balance.last = ledger;

  row.push_back(static_cast<Real>(particles.contacts));
  row.push_back(static_cast<Real>(state.carried_out.left));
  row.push_back(static_cast<Real>(bodies_outside(model_, state.bodies).count));
  for (const Real entry : ledger.entries()) row.push_back(entry);
  row.insert(row.end(), {ledger.mechanical(), ledger.accounted() - balance.start, balance.exchanged});
  append(row, particles.momentum);
  append(row, particles.angular_momentum);
}

void Recorder::reaction_row(const State& state, std::vector<Real>& row) const {
  for (const Reaction& reaction : reactions_of(model_, link_, state))
    row.insert(row.end(), {reaction.force.x, reaction.force.y, reaction.torque});
}

void Recorder::body_row(const State& state, std::vector<Real>& row) const {
  if (link_.multibody() == nullptr || model_.output.history_bodies.empty()) return;
  const std::vector<BodyMotion> motion = link_.multibody()->motion(state.bodies);
  for (const int body : model_.output.history_bodies) {
    append(row, motion[body].position);
    append(row, motion[body].velocity);
    row.insert(row.end(), {motion[body].angle, motion[body].angular_velocity});
  }
}

void Recorder::particle_row(std::vector<Real>& row) {
  if (model_.output.history_particles.empty()) return;
  write_pending();  // the backend holds one pack
  backend_.start_pack();
  const std::vector<Traced> traced =
      link_.ranks().gather(traced_of(backend_.pack_particles(), model_.output.history_particles));
  for (const GlobalId id : model_.output.history_particles) {
    const auto found =
        std::find_if(traced.begin(), traced.end(), [&](const Traced& t) { return t.global_id == id; });
    if (found == traced.end()) {  // removed
      row.insert(row.end(), 6, std::nan(""));
      continue;
    }
    append(row, found->position);
    append(row, found->velocity);
  }
}

void Recorder::snapshot(State& state) {
  write_pending();
  backend_.start_pack();
  PendingSnapshot next{state.clock.time, backend_.pack_shapes(), {}, {}};
  const std::vector<BodyMotion> motion = link_.motion();
  for (const int body : next.shapes.body) {
    next.angle.push_back(motion[body].angle);
    next.angular_velocity.push_back(motion[body].angular_velocity);
  }
  pending_ = std::move(next);
  ++state.snapshots;
  if (!writes_late()) write_pending();
}

void Recorder::write_pending() {
  if (!pending_) return;
  const PendingSnapshot snapshot = *std::exchange(pending_, std::nullopt);
  const ParticlePack p = in_id_order(link_.ranks(), model_.particles.totals.count, backend_.pack_particles());
  const ShapePack& s = snapshot.shapes;
  snapshots_->append(snapshot.time, {p.global_id, p.radius, p.position, p.velocity, p.force, p.contacts},
                     {s.body, s.radius, s.position, s.velocity, snapshot.angle, snapshot.angular_velocity,
                      s.force, s.contacts});
}

void Recorder::flush_history() {
  if (history_) history_->flush();
}

void Recorder::flush() {
  write_pending();
  link_.ranks().on_root([&] { history_->flush(); });
}

void Recorder::finish() {
  flush();
  snapshots_->finish();
}

}  // namespace scree
