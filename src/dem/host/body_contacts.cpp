#include "dem/host/body_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/countable.hpp"
#include "base/index.hpp"
#include "dem/surface_contact/wall_items.hpp"
#include "model/derived/point_bins.hpp"
#include "partition/halo_plan.hpp"
#include "partition/level_grids.hpp"

namespace scree {
namespace {

// Bins over the surfaces' positions, in which spheres that can touch are in neighbouring bins.
SortedBins bins_of(std::span<const SurfacePose> placed, Real skin) {
  Vec3 min = placed.empty() ? Vec3{} : placed[0].point, max = min;
  Real radius = 0;
  std::vector<StartItem> points;
  for (Index i = 0; i < static_cast<Index>(placed.size()); ++i) {
    const SurfacePose& s = placed[i];
    if (s.kind != SurfaceKind::sphere) continue;
    min = {std::min(min.x, s.point.x), std::min(min.y, s.point.y), std::min(min.z, s.point.z)};
    max = {std::max(max.x, s.point.x), std::max(max.y, s.point.y), std::max(max.z, s.point.z)};
    radius = std::max(radius, s.radius), points.push_back({s.point, s.radius, i});
  }
  return SortedBins(PointCells(min, max, 2 * radius + skin, points.size()), points);
}

// Mass of the body of each placed surface; infinite for walls [kg].
std::vector<Real> masses_of_parents(const Model& model, const SurfaceSet& surfaces) {
  std::vector<Real> masses;
  for (Index s = 0; s < surfaces.placed(); ++s)
    masses.push_back(surfaces.is_on_body(s) ? model.bodies[as_size(surfaces.at(s).parent)].mass : kInfinity);
  return masses;
}

}  // namespace

ContactSum make_wall_contact(const Real* sums) {
  const auto vector = [&](int first) { return Vec3{sums[first], sums[first + 1], sums[first + 2]}; };
  return {vector(kWallForce), vector(kWallTorque), std::llround(sums[kWallContacts])};
}

BodyContacts::BodyContacts(const Model& model, const SurfaceSet& surfaces, const Subdomain& subdomain)
    : model_(model),
      surfaces_(surfaces),
      rule_(model),
      corners_(model, surfaces),
      period_(subdomain.period()),
      snap_(subdomain.snap_constant()),
      kernels_(make_contact_kernels(corners_.with_own_materials(model.contact))),
      planes_(wall_planes(model)),
      entries_(model, subdomain, *kernels_, model.contact.interaction_range,
               masses_of_parents(model, surfaces)),
      accepted_(packed_content(model, kernels_->traits().history), {model.space.min, subdomain.period()}),
      trial_(accepted_) {}

// Possible partners of each placed surface, in order.
std::vector<std::vector<BodyContacts::Item>> BodyContacts::find_partners(std::span<const SurfacePose> placed,
                                                                         Real skin) const {
  std::vector<std::vector<Item>> partners(placed.size());
  if (!rule_.bodies_may_touch()) return partners;
  const Real beyond_touch = skin + model_.contact.interaction_range;
  const SortedBins bins = bins_of(placed, beyond_touch);
  for_each_shift(period_, [&](Vec3 shift, std::int8_t image) {
    for (Index i = 0; i < static_cast<Index>(placed.size()); ++i) {
      if (placed[i].kind != SurfaceKind::sphere) continue;
      bins.for_near(placed[i].point - shift, [&](const StartItem& other) {
        const auto j = static_cast<Index>(other.number);
        const Vec3 d = placed[i].point - other.position - shift;
        const Real distance = placed[i].radius + other.radius + beyond_touch;
        const Surface &one = surfaces_.at(i), &two = surfaces_.at(j);
        if (dot(d, d) < distance * distance && rule_.may_touch(one.parent, two.parent) &&
            model_.contact.law(one.material, two.material).acts())
          partners[i].push_back({j, image});
      });
    }
  });
  for (std::vector<Item>& row : partners) std::sort(row.begin(), row.end());
  return partners;
}

std::vector<Index> BodyContacts::find_shapes(const SurfacePoses& poses, Real skin) const {
  std::vector<Index> shapes;
  for (Index s = 0; s < static_cast<Index>(poses.placed.size()); ++s)
    if (poses.placed[s].kind == SurfaceKind::sphere) shapes.push_back(s);
  corners_.add_near_planes(poses, planes_, skin + poses.most_extra_travel(), shapes);
  return shapes;
}

// Finds the rows of these shapes with all surfaces that are not spheres. Vertices of meshes move as far as
// their meshes: planes near them are searched in the range used for particles near meshes.
void BodyContacts::find_surfaces(const SurfacePoses& poses, Real skin, const std::vector<Index>& shapes,
                                 SurfaceRows& rows) const {
  std::vector<Vec4> position;
  Vec3 min, max;
  Real largest = 0;
  for (const Index s : shapes) {
    const bool is_corner = corners_.has(s);
    const SurfacePose& shape = poses.placed[static_cast<std::size_t>(corners_.surface_of(s))];
    const Vec3 p =
        is_corner ? shape.point + poses.frames[shape.frame].axes * corners_.position_of(s) : shape.point;
    const Real radius = is_corner ? poses.most_extra_travel() : shape.radius;
    if (position.empty()) min = max = p;
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    largest = std::max(largest, radius), position.push_back(vec4(p, radius));
  }
  const auto n = static_cast<Index>(position.size());
  const Real beyond_touch = skin + model_.contact.interaction_range;
  LevelCells cells;
  cells.levels = {{make_cell_grid(min, max, 3, 2 * largest + beyond_touch, 4 * n + 64), 0, n, largest}};
  std::vector<Index> cell_of;
  for (const Vec4& p : position) cell_of.push_back(cells.levels.front().nearest(xyz(p)));
  cells.sort(cell_of);
  const auto may_touch = [&](Index i, Index s) {
    if (corners_.has(shapes[i])) return surfaces_.at(s).kind == SurfaceKind::plane;
    return surfaces_.at(s).kind != SurfaceKind::sphere &&
           rule_.may_touch(parent_of(shapes[i]), surfaces_.at(s).parent);
  };
  const auto stored_contacts = [&](Index i, Index surface) {
    return packed_.contacts_with(shapes[i], surface);
  };
  build_rows({cells, position, n}, n,
             {surfaces_, planes_, poses, period_, beyond_touch, stored_contacts, may_touch}, rows);
}

// Lists these shapes, then the periodic images of their partners.
void BodyContacts::list_items(const std::vector<Index>& shapes,
                              const std::vector<std::vector<Item>>& partners) {
  std::map<Item, Index> item_of;
  items_.clear(), list_.neighbors.clear(), list_.offsets = {0};
  for (const Index s : shapes) {
    item_of.emplace(Item{s, kZeroShift}, static_cast<Index>(items_.size()));
    items_.push_back({s, kZeroShift});
  }
  const std::vector<Item> none;  // for mesh vertices
  for (const Index s : shapes) {
    for (const Item& partner : corners_.has(s) ? none : partners[s]) {
      const auto [found, is_new] = item_of.emplace(partner, static_cast<Index>(items_.size()));
      if (is_new) items_.push_back(partner);
      list_.neighbors.push_back(found->second);
    }
    list_.offsets.push_back(countable(list_.neighbors.size(), "stage neighbors: more neighbours of bodies"));
  }
  store_.owned = store_.active = static_cast<Index>(shapes.size());
  store_.material.clear(), store_.row_key.clear();
  std::vector<Real> law_radius;
  for (const Item& item : items_) {
    const Surface& surface = surfaces_.at(corners_.surface_of(item.surface));
    const bool is_corner = corners_.has(item.surface);
    store_.material.push_back(is_corner ? corners_.material(surface.material) : surface.material);
    law_radius.push_back(is_corner ? corners_.mesh_of(item.surface).hull->radius : surface.radius);
    store_.row_key.push_back(row_key(item.surface, item.image));
  }
  entries_.set_law_radii(corners_.empty() ? std::vector<Real>{} : std::move(law_radius));
}

void BodyContacts::build(const SurfacePoses& poses, Real skin) {
  const std::vector<std::vector<Item>> partners = find_partners(poses.placed, skin);
  const std::vector<Index> all = find_shapes(poses, skin);
  std::vector<Index> near;
  find_surfaces(poses, skin, all, list_.surfaces);
  const std::vector<Index>& offsets = list_.surfaces.offsets;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (offsets[k + 1] > offsets[k] || (!corners_.has(all[k]) && !partners[all[k]].empty()))
      near.push_back(all[k]);
  if (near.size() < all.size()) find_surfaces(poses, skin, near, list_.surfaces);
  list_items(near, partners);
  set_items(poses, Instant::now, 0);
  if (accepted_.exists()) unpack_shape_contacts(poses);
  has_list_ = true;
}

// Unpacks the history of the shapes in the list; the contacts of all others have ended.
void BodyContacts::unpack_shape_contacts(const SurfacePoses& poses) {
  PackedHistory rows;
  rows.content = packed_.content;
  std::size_t k = 0;
  for (Index i = 0; i < store_.owned; ++i) {
    for (; k < packed_.shapes.size() && packed_.shapes[k] <= items_[i].surface; ++k)
      if (packed_.shapes[k] == items_[i].surface) rows.add(packed_.keys[k], packed_.values_of(k));
    rows.end_row();
  }
  accepted_.load(rows, store_.owned);
  accepted_.unpack_history(listed(poses));
}

void BodyContacts::pack_list(const SurfacePoses& poses) {
  if (!has_list_ || !accepted_.exists()) return;
  packed_ = contacts(poses);
  has_list_ = false;
}

void BodyContacts::load(const ShapeContacts& contacts) {
  packed_ = contacts.content == accepted_.content() ? contacts : ShapeContacts{};
  packed_.content = accepted_.content();
  has_list_ = false;
}

ShapeContacts BodyContacts::contacts(const SurfacePoses& poses) {
  if (!has_list_) return packed_;
  ShapeContacts out;
  out.content = accepted_.content();
  if (!accepted_.exists()) return out;
  set_items(poses, Instant::now, 0);
  const PackedHistory rows = accepted_.contacts(listed(poses));
  for (Index i = 0; i < store_.owned; ++i)
    out.shapes.insert(out.shapes.end(), static_cast<std::size_t>(rows.contacts(i)), items_[i].surface);
  out.keys = rows.keys, out.values = rows.values;
  return out;
}

void BodyContacts::accept() {
  if (!has_step_) return;
  std::swap(accepted_, trial_);
  has_step_ = false;
}

void BodyContacts::reopen() { std::swap(accepted_, trial_); }

void BodyContacts::set_items(const SurfacePoses& poses, Instant when, Real h) {
  const bool at_start = when == Instant::start, at_middle = h > 0 && model_.rotates();
  std::vector<FreeShape> free_shapes;
  store_.position.clear(), store_.velocity.clear(), store_.angular_velocity.clear(), arm_.clear();
  for (const Item& item : items_) {
    const auto surface = as_size(corners_.surface_of(item.surface));
    const SurfacePose& s = (at_start ? poses.start : poses.placed)[surface];
    const Body& body = model_.bodies[as_size(parent_of(item.surface))];
    const bool is_corner = corners_.has(item.surface);
    const CornerPose at =
        is_corner ? corner_pose(s, poses.frames[s.frame], corners_.position_of(item.surface), at_start, snap_)
                  : CornerPose{s.point, s.arm, s.velocity_at({}), s.displacement};
    store_.position.push_back(vec4(at.point + image_shift(item.image, period_), s.radius));
    store_.velocity.push_back(vec4(at_middle ? reciprocal(h) * at.displacement : at.velocity, body.mass));
    store_.angular_velocity.push_back(vec4(at_middle ? reciprocal(h) * s.turn : s.spin, body.inertia));
    arm_.push_back(at.arm);
    if (!poses.free_bodies.empty()) free_shapes.push_back({at.arm, poses.free_bodies[surface]});
  }
  entries_.set_free_shapes(std::move(free_shapes));
}

// Sets the start arrays; the items are left at the start of the step.
void BodyContacts::set_start_items(const SurfacePoses& poses, Real h) {
  set_items(poses, Instant::now, h);
  mean_spin_ = store_.angular_velocity;
  set_items(poses, Instant::start, 0);
  start_position_ = store_.position, start_velocity_ = store_.velocity;
  start_spin_ = store_.angular_velocity;
}

StepStart BodyContacts::step_start(Real h) const {
  return {start_position_.data(), start_velocity_.data(), h, model_.integrator.resolve_events};
}

ContactViews<PackedRows> BodyContacts::views(const HistoryViews& history) const {
  ContactViews<PackedRows> views =
      entries_.views(store_, store_.position, store_.velocity, {list_.offsets.data(), list_.neighbors.data()},
                     list_.surfaces);
  views.history = history, views.spin = store_.angular_velocity.data(),
  views.interaction_range = model_.contact.interaction_range;
  return views;
}

void BodyContacts::find_loads(const SurfacePoses& poses, Real h) {
  const bool in_step = h > 0 && accepted_.exists();
  if (!in_step) h = 0;
  if (in_step) trial_ = accepted_, has_step_ = true;
  const HistoryViews history = in_step ? trial_.views() : accepted_.views().only_read();
  set_items(poses, Instant::now, h);
  entries_.find_loads(
      poses, store_, list_.surfaces,
      {store_.position.data(), store_.velocity.data(), store_.angular_velocity.data(), history, h});
  loads_.resize(static_cast<std::size_t>(store_.owned));
  kernels_->run(views(history), store_.owned, BodyLoadRequest{arm_.data(), h, loads_.data()});
  for (Index i = 0; i < store_.owned; ++i) loads_[i].sums.surface = corners_.surface_of(items_[i].surface);
  if (in_step) trial_.accepted();
}

void BodyContacts::find_steps(const SurfacePoses& poses, Real h) {
  set_start_items(poses, h);
  set_items(poses, Instant::now, 0);
  steps_.resize(static_cast<std::size_t>(store_.owned));
  with_shapes_.resize(list_.neighbors.size());
  const ShapeContactsTo to{list_.offsets.data(), with_shapes_.data()};
  FrictionStart start{step_start(h), start_spin_.data(), mean_spin_.data(), {}, nullptr};
  if (accepted_.exists()) trial_ = accepted_, has_step_ = true;
  entries_.find_steps(poses, store_, list_.surfaces, start, trial_.views());
  start.on_bodies = entries_.friction_steps();
  kernels_->run(views(trial_.views()), store_.owned, BodyStepRequest{start, arm_.data(), steps_.data(), to});
  if (accepted_.exists()) trial_.accepted();
  for (Index i = 0; i < store_.owned; ++i) steps_[i].sums.surface = corners_.surface_of(items_[i].surface);
  find_pairs();
}

// A contact of two shapes appears in both rows; the row of the lower number counts. Shapes may also touch
// meshes of bodies.
void BodyContacts::find_pairs() {
  pairs_.clear();
  const auto touched = [&](Index item, Vec3 towards) -> TouchedBody {
    return {parent_of(items_[item].surface), arm_[item] + store_.position[item].w * towards};
  };
  for (Index i = 0; i < store_.owned; ++i)
    for (Index k = 0; k < steps_[i].partners; ++k) {
      const ShapeContact& contact = with_shapes_[list_.offsets[i] + k];
      if (items_[contact.other].surface < items_[i].surface) continue;
      const Vec3 towards = -contact.slopes.normal;
      pairs_.add(touched(i, towards), touched(contact.other, -towards), contact.slopes);
    }
  entries_.for_each_slope(
      list_.surfaces, [&](Index item, Index surface, Vec3 contact_point, const auto& slopes) {
        if (surfaces_.is_on_body(surface))
          pairs_.add(touched(item, -slopes.normal), {surfaces_.at(surface).parent, contact_point}, slopes);
      });
}

void BodyContacts::add_sums(std::vector<InstantSums>& to) const {
  for (const BodyLoad& load : loads_)
    if (load.sums.contacts > 0) to.push_back(load.sums);
  const std::vector<InstantSums> of_surfaces = entries_.load_sums(list_.surfaces);
  to.insert(to.end(), of_surfaces.begin(), of_surfaces.end());
}

void BodyContacts::add_sums(std::vector<StepSums>& to) const {
  for (const BodyStep& step : steps_)
    if (step.sums.contacts > 0) to.push_back(step.sums);
  const std::vector<StepSums> of_surfaces = entries_.step_sums(list_.surfaces);
  to.insert(to.end(), of_surfaces.begin(), of_surfaces.end());
}

BodyContactTotals BodyContacts::totals() const {
  BodyContactTotals sum;
  for (const BodyLoad& load : loads_) {
    sum.loss_power += load.loss, sum.elastic_energy += load.energy, sum.pairs += load.pairs;
    sum.cohesion += load.cohesion, sum.springs.add(load.springs, 1), sum.losses.add(load.losses);
  }
  return sum;
}

BodyStep BodyContacts::step_totals() const {
  BodyStep sum;
  for (const BodyStep& step : steps_) sum.losses.add(step.losses, 1), sum.tangential.add(step.tangential);
  return sum;
}

void BodyContacts::accumulate_load_works(const SurfacePoses& poses, Real h) {
  entries_.accumulate_load_works(poses, store_, list_.surfaces, h);
}

void BodyContacts::accumulate_step_works(const SurfacePoses& poses) {
  entries_.accumulate_step_works(poses, store_, list_.surfaces);
}

std::vector<TriangleSums> BodyContacts::triangle_sums() const {
  return entries_.triangle_sums(list_.surfaces);
}

ContactSum BodyContacts::on_wall(int wall) {
  Real sums[kWallTerms];
  kernels_->wall_sums(views(accepted_.views().only_read()), store_.owned, {wall, model_.space.min, period_},
                      Ranks(), sums);
  return make_wall_contact(sums);
}

std::vector<ContactLine> BodyContacts::lines(const SurfacePoses& poses) {
  const HistoryViews history = accepted_.views().only_read();
  const std::vector<ShownContact> of_surfaces = entries_.shown(poses, store_, list_.surfaces, history);
  std::vector<Index> counts(static_cast<std::size_t>(store_.owned));
  std::vector<ContactLine> lines =
      contact_lines(*kernels_, views(history),
                    {store_.row_key.data(), of_surfaces.data(), model_.space.min, period_}, counts);
  // Items are identified by their numbers among the placed surfaces.
  const auto id_of_shape = [&](GlobalId item) {
    return surface_id(surfaces_.number_of(corners_.surface_of(static_cast<Index>(item))));
  };
  for (ContactLine& line : lines) {
    line.first = id_of_shape(line.first);
    if (surface_with_id(line.second) < 0) line.second = id_of_shape(line.second);
  }
  return lines;
}

}  // namespace scree
