#include "run/record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "dem/reports/triangle_works.hpp"
#include "model/derived/connections.hpp"
#include "partition/id_order.hpp"
#include "run/record/contact_network.hpp"
#include "run/record/output_plan.hpp"
#include "run/record/target_contacts.hpp"
#include "run/report/balance.hpp"
#include "run/report/bodies_outside.hpp"

namespace scree {
namespace {

// The reactions that the deck selects for the history.
std::vector<Reaction> reactions_of(const Model& model, const BodyCoupling& link, const State& state) {
  if (link.multibody() == nullptr || model.output.history_reactions == 0) return {};
  std::vector<Reaction> reactions = link.multibody()->reactions(state.bodies, state.clock.time);
  const auto wanted = as_size(model.output.history_reactions);
  if (reactions.size() > wanted) reactions.resize(wanted);
  return reactions;
}

std::vector<JointEffortSample> efforts_of(const Model& model, const BodyCoupling& link, const State& state) {
  if (link.multibody() == nullptr || model.output.history_efforts == 0) return {};
  std::vector<JointEffortSample> efforts = link.multibody()->joint_efforts(state.bodies, state.clock.time);
  const auto wanted = as_size(model.output.history_efforts);
  if (efforts.size() > wanted) efforts.resize(wanted);
  return efforts;
}

std::vector<JointReading> coordinates_of(const BodyCoupling& link, const State& state) {
  if (link.multibody() == nullptr) return {};
  return link.multibody()->joint_readings(state.bodies, state.clock.time);
}

std::vector<BushingSample> bushings_of(const Model& model, const BodyCoupling& link, const State& state) {
  if (link.multibody() == nullptr || model.output.history_bushings == 0) return {};
  std::vector<BushingSample> bushings = link.multibody()->bushings(state.bodies, state.clock.time);
  const auto wanted = as_size(model.output.history_bushings);
  if (bushings.size() > wanted) bushings.resize(wanted);
  return bushings;
}

// Positions of the particles that the deck traces, NaN for removed ones. Complete on rank 0.
std::vector<TracedParticle> traced_of(const Model& model, const Ranks& ranks, Backend& backend) {
  const std::vector<GlobalId>& wanted = model.output.history_particles;
  if (wanted.empty()) return {};
  const std::vector<TracedParticle> all = ranks.gather(backend.reports().traced(wanted));
  const Vec3 nowhere{std::nan(""), std::nan(""), std::nan("")};
  std::vector<TracedParticle> traced;
  for (const GlobalId id : wanted) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const TracedParticle& t) { return t.global_id == id; });
    traced.push_back(found != all.end() ? *found : TracedParticle{id, nowhere, nowhere, nowhere});
  }
  return traced;
}

// This rank's part of the output in the order of the ids, which are below `bound`, with the fields that are
// functions of the id.
ParticleOutput in_id_order(const Ranks& ranks, const Model& model, GlobalId bound, ParticleOutput p) {
  const IdOrder order(ranks, bound, p.global_id);
  p.global_id = order.apply(std::move(p.global_id)), p.position = order.apply(std::move(p.position));
  for (OutputValues& of_field : p.fields)
    std::visit([&](auto& values) { values = order.apply(std::move(values)); }, of_field);
  const std::vector<OutputField> wanted = wanted_fields(model.output);
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if (wanted[k].of_id)
      p.fields.insert(p.fields.begin() + static_cast<std::ptrdiff_t>(k),
                      groups_of(model.particles, p.global_id));
  return p;
}

EnergyExtremes extremes_of(const HistorySample& now, const State& state) {
  return extremes_at(now.particles.inside.kinetic, now.ledger.elastic_force_elements, state.bodies);
}

}  // namespace

Recorder::Recorder(const Model& model, Backend& backend, const BodyCoupling& link,
                   const std::string& directory, const State& state)
    : model_(model), backend_(backend), body_coupling_(link) {
  link.ranks().on_root([&] {
    columns_ = history_columns(model, reactions_of(model, link, state), efforts_of(model, link, state),
                               coordinates_of(link, state), bushings_of(model, link, state));
    std::vector<HistoryColumn> heads;
    for (const RecordedColumn& column : columns_) heads.push_back(column.head);
    stops_.emplace(model.stop_conditions, columns_);
    history_.emplace(directory, heads, model.output.history_csv, state.history_rows, likely_rows(model));
    if (!model.meshes.empty()) surfaces_.emplace(model);
    if (model.output.links && link.multibody() != nullptr) links_.emplace(model);
    if (links_ && links_->empty()) links_.reset();
  });
  SeriesOptions options = series_options(model);
  options.keep = static_cast<int>(state.snapshots), options.ranks = link.ranks();
  if (surfaces_) options.triangles = surfaces_->triangles();
  snapshots_.emplace(directory, options, wanted_lines());
  if (writes_deferred()) backend.set_idle_work([this] { write_pending(); });
}

WantedLines Recorder::wanted_lines() const {
  WantedLines lines{model_.output.contacts, ContactNetwork::field_names(model_),
                    model_.particles.totals.count};
  if (links_) lines.links = links_->names();
  return lines;
}

// Snapshots are written late only on a single rank: with several ranks the writing is collective, and the
// ranks wait for their devices at different times.
bool Recorder::writes_deferred() const {
  return backend_.computes_asynchronously() && body_coupling_.ranks().alone();
}

Recorder::~Recorder() { backend_.set_idle_work({}); }

void Recorder::history(State& state, Real h) {
  const HistorySample sample = take_sample(state, h);
  contacts_ = sample.particles.contacts;
  if (history_) {
    std::vector<Real> row;
    for (const RecordedColumn& column : columns_) row.push_back(column.value(sample));
    history_->append(row);
    stops_->adopt(state.stop_watches);
    stops_->add_row(sample.time, row, state.stop_watches);
  }
  ++state.history_rows;
  find_stop(state);
}

void Recorder::find_stop(State& state) {
  if (model_.stop_conditions.empty()) return state.stop_watches.clear();
  if (stops_) stops_->adopt(state.stop_watches), stop_reason_ = stops_->reason(state.stop_watches);
  should_end_ = body_coupling_.ranks().any(!stop_reason_.empty());
}

HistorySample Recorder::take_sample(State& state, Real h) const {
  HistorySample sample;
  sample.time = state.clock.time, sample.step = h;
  sample.counts = state.counts;
  balance(state, sample);
  sample.left = state.carried_out.left;
  sample.population = population_sample(model_, state);
  sample.bodies_outside = bodies_outside(model_, state.bodies).count;
  sample.reactions = reactions_of(model_, body_coupling_, state);
  sample.efforts = efforts_of(model_, body_coupling_, state);
  sample.coordinates = coordinates_of(body_coupling_, state);
  sample.bushings = bushings_of(model_, body_coupling_, state);
  sample.contacts = target_contacts(model_, body_coupling_, state, backend_);
  if (body_coupling_.multibody() != nullptr && !model_.output.history_bodies.empty())
    sample.bodies = body_coupling_.multibody()->motion(state.bodies);
  for (const HistoryRegion& region : model_.output.history_regions)
    sample.regions.push_back(backend_.reports().in_region(region.bounds));
  sample.traced = traced_of(model_, body_coupling_.ranks(), backend_);
  return sample;
}

void Recorder::sample_energies(State& state) {
  const Real kinetic = backend_.reports().inside_kinetic();
  const Multibody* const bodies = body_coupling_.multibody();
  const Real elastic = bodies == nullptr ? 0 : bodies->energies(state.bodies, state.clock.time).elastic;
  add_sample(state.balance, extremes_at(kinetic, elastic, state.bodies));
}

void Recorder::rebase_balance(State& state) {
  HistorySample now;
  take_energies(state, now);
  rebase(state.balance, now.inside, extremes_of(now, state));
}

void Recorder::take_energies(const State& state, HistorySample& sample) const {
  sample.particles = backend_.reports().ledger(verlet_step(model_));
  sample.ledger = make_ledger(sample.particles, state.carried_out, body_coupling_.multibody(), state.bodies,
                              state.clock.time, state.population.born_energy());
  sample.inside = inside_ledger(sample.ledger, sample.particles, state.carried_out);
  // The check is left out at the start, where the first step gives a more specific error.
  if (state.balance.open && body_coupling_.ranks().any(!std::isfinite(sample.ledger.mechanical())))
    throw SimulationError("stage output: the energy of particles and bodies is not finite");
}

// Fills in the energies and updates the balance.
void Recorder::balance(State& state, HistorySample& sample) const {
  take_energies(state, sample);
  sample.losses = sample.particles.rotation.losses;
  sample.losses.add(state.carried_out.losses);
  add_row(state.balance, sample.inside, extremes_of(sample, state), state.bodies);
  sample.balance_error = balance_error(state.balance), sample.exchanged = state.balance.exchanged;
}

void Recorder::snapshot(State& state) {
  write_pending();
  const Reports::Instant now(backend_.reports());
  backend_.reports().start_output();
  PendingSnapshot next{state.clock.time, id_bound(model_.particles, state.population), {}, {}, {}, {}};
  const std::vector<BodyMotion> motion = body_coupling_.motion();
  if (!model_.bodies.empty()) {
    const ShapePack shapes = backend_.reports().pack_shapes();
    const std::vector<ContactSum> contacts = backend_.reports().parent_contacts();
    if (body_coupling_.ranks().is_root()) next.bodies = body_points(model_, shapes, motion, contacts);
  }
  if (!model_.meshes.empty()) {
    const Output& output = model_.output;
    std::vector<TriangleLoad> loads;
    if (output.shows(SurfaceField::pressure) || output.shows(SurfaceField::shear))
      loads = backend_.reports().triangle_loads();
    const std::vector<std::int64_t> works = all_works(backend_.particles().works(), body_coupling_.ranks());
    if (surfaces_) next.surfaces = surfaces_->sample(motion, loads, works);
  }
  if (model_.output.contacts) next.contacts = backend_.reports().contact_lines();
  if (links_)
    next.links = links_->sample(*body_coupling_.multibody(), state.bodies, state.clock.time, motion);
  pending_ = std::move(next);
  ++state.snapshots;
  if (!writes_deferred()) write_pending();
}

void Recorder::write_pending() {
  if (!pending_) return;
  PendingSnapshot snapshot = *std::exchange(pending_, std::nullopt);
  const ParticleOutput p =
      in_id_order(body_coupling_.ranks(), model_, snapshot.id_bound, backend_.reports().output());
  ContactNetwork contacts;
  if (model_.output.contacts)
    contacts =
        ContactNetwork(model_, body_coupling_.ranks(), snapshot.id_bound, std::move(snapshot.contacts));
  const MeshSurfaces::Sample& surfaces = snapshot.surfaces;
  snapshots_->append(snapshot.time, {p.global_id, p.position, point_fields(model_.output, p.fields)},
                     snapshot.bodies.view(),
                     {surfaces.position, surfaces.pressure, surfaces.shear, surfaces.impact_work,
                      surfaces.sliding_work, surfaces.wear_depth},
                     contacts.snapshot(), snapshot.links.snapshot());
}

void Recorder::flush_history() {
  if (history_) history_->flush();
}

void Recorder::flush() {
  write_pending();
  body_coupling_.ranks().on_root([&] { history_->flush(); });
}

void Recorder::finish() {
  flush();
  snapshots_->finish();
}

}  // namespace scree
