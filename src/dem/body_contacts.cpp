#include "dem/body_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/countable.hpp"
#include "dem/wall_items.hpp"
#include "model/point_bins.hpp"
#include "partition/halo_plan.hpp"

namespace scree {
namespace {

// Cells over the places of the surfaces, so that two that can touch are in neighbouring ones.
SortedBins bins_of(std::span<const PlacedSurface> placed, Real skin) {
  Vec3 min = placed.empty() ? Vec3{} : placed[0].point, max = min;
  Real radius = 0;
  std::vector<StartItem> points;
  for (Index i = 0; i < static_cast<Index>(placed.size()); ++i) {
    const PlacedSurface& s = placed[i];
    if (s.kind != SurfaceKind::sphere) continue;
    min = {std::min(min.x, s.point.x), std::min(min.y, s.point.y), std::min(min.z, s.point.z)};
    max = {std::max(max.x, s.point.x), std::max(max.y, s.point.y), std::max(max.z, s.point.z)};
    radius = std::max(radius, s.radius);
    points.push_back({s.point, s.radius, i});
  }
  return SortedBins(PointCells(min, max, 2 * radius + skin, points.size()), points);
}

// Bodies neither attract each other nor are they attracted by walls: these contacts follow the laws without
// attraction, with tension as the dampers of laws with it have.
Contact without_attraction(Contact contact) {
  for (KelvinVoigt& law : contact.laws)
    if (law.attracts()) law = law.without_attraction(), law.tension = true;
  return contact;
}

}  // namespace

ContactSum make_wall_contact(const Real* sums) {
  const auto vector = [&](int first) { return Vec3{sums[first], sums[first + 1], sums[first + 2]}; };
  return {vector(kWallForce), vector(kWallTorque), std::llround(sums[kWallContacts])};
}

BodyContacts::BodyContacts(const Model& model, const SurfaceSet& surfaces, const Subdomain& subdomain)
    : model_(model),
      surfaces_(surfaces),
      subdomain_(subdomain),
      rule_(model),
      kernels_(make_contact_kernels(without_attraction(model.contact))),
      planes_(wall_planes(model)) {}

// Per surface, in order.
std::vector<std::vector<BodyContacts::Item>> BodyContacts::find_partners(
    std::span<const PlacedSurface> placed, Real skin) const {
  std::vector<std::vector<Item>> partners(placed.size());
  if (!rule_.bodies_may_touch()) return partners;
  const SortedBins bins = bins_of(placed, skin);
  for_each_shift(subdomain_.period(), [&](Vec3 shift, std::int8_t image) {
    for (Index i = 0; i < static_cast<Index>(placed.size()); ++i) {
      if (placed[i].kind != SurfaceKind::sphere) continue;
      bins.for_near(placed[i].point - shift, [&](const StartItem& other) {
        const auto j = static_cast<Index>(other.number);
        const Vec3 d = placed[i].point - other.position - shift;
        const Real reach = placed[i].radius + other.radius + skin;
        if (dot(d, d) < reach * reach && rule_.may_touch(surfaces_.at(i).carrier, surfaces_.at(j).carrier))
          partners[i].push_back({j, image});
      });
    }
  });
  for (std::vector<Item>& row : partners) std::sort(row.begin(), row.end());
  return partners;
}

void BodyContacts::build(std::span<const PlacedSurface> placed, Real skin) {
  const std::vector<std::vector<Item>> partners = find_partners(placed, skin);
  items_.clear(), neighbors_.clear(), walls_.clear(), material_.clear();
  offsets_ = wall_offsets_ = {0};
  std::map<Item, Index> item_of;
  for (Index i = 0; i < static_cast<Index>(placed.size()); ++i) {
    const PlacedSurface& s = placed[i];
    if (s.kind != SurfaceKind::sphere) continue;  // meshes meet particles alone
    const auto before = walls_.size();
    for (Index w = 0; w < static_cast<Index>(planes_.size()); ++w) {
      if (planes_[w].placed < 0 && wall_pair(vec4(s.point, s.radius), planes_[w]).distance < s.radius + skin)
        walls_.push_back(w);
    }
    if (walls_.size() == before && partners[i].empty()) continue;
    item_of.emplace(Item{i, kNoShift}, static_cast<Index>(items_.size()));
    items_.push_back({i, kNoShift});
    wall_offsets_.push_back(static_cast<Index>(walls_.size()));
  }
  originals_ = static_cast<Index>(items_.size());
  for (Index i = 0; i < originals_; ++i) {
    for (const Item& partner : partners[items_[i].surface]) {
      const auto [found, is_new] = item_of.emplace(partner, static_cast<Index>(items_.size()));
      if (is_new) items_.push_back(partner);
      neighbors_.push_back(found->second);
    }
    offsets_.push_back(countable(neighbors_.size(), "stage neighbors: more neighbours of bodies"));
  }
  for (const Item& item : items_) material_.push_back(surfaces_.at(item.surface).material);
}

void BodyContacts::place(std::span<const PlacedSurface> placed, std::vector<Vec4>& position,
                         std::vector<Vec4>& velocity, std::vector<Vec3>& arm) const {
  position.clear(), velocity.clear(), arm.clear();
  for (const Item& item : items_) {
    const PlacedSurface& s = placed[item.surface];
    position.push_back(vec4(s.point + image_shift(item.image, subdomain_.period()), s.radius));
    const Body& body = model_.bodies[static_cast<std::size_t>(surfaces_.at(item.surface).carrier)];
    velocity.push_back(vec4(s.velocity_at({}), body.mass));
    arm.push_back(s.arm);
  }
}

ContactViews<PackedRows> BodyContacts::views() const {
  return {position_.data(),
          velocity_.data(),
          material_.data(),
          {offsets_.data(), neighbors_.data()},
          wall_offsets_.data(),
          walls_.data(),
          {planes_.data(), static_cast<Index>(planes_.size())},
          nullptr,
          nullptr};
}

void BodyContacts::find(std::span<const PlacedSurface> placed) {
  place(placed, position_, velocity_, arm_);
  loads_.resize(static_cast<std::size_t>(originals_));
  kernels_->body_loads(views(), originals_, arm_.data(), loads_.data());
  for (Index i = 0; i < originals_; ++i) loads_[i].sums.surface = items_[i].surface;
}

void BodyContacts::find(std::span<const PlacedSurface> placed, std::span<const PlacedSurface> start, Real h) {
  place(start, start_position_, start_velocity_, arm_);
  place(placed, position_, velocity_, arm_);
  steps_.resize(static_cast<std::size_t>(originals_));
  kernels_->body_steps(views(), originals_,
                       {start_position_.data(), start_velocity_.data(), h, model_.integrator.resolve_events},
                       arm_.data(), steps_.data());
  for (Index i = 0; i < originals_; ++i) steps_[i].sums.surface = items_[i].surface;
}

Real BodyContacts::loss_power() const {
  Real sum = 0;
  for (const BodyLoad& load : loads_) sum += load.loss;
  return sum;
}

Real BodyContacts::elastic_energy() const {
  Real sum = 0;
  for (const BodyLoad& load : loads_) sum += load.energy;
  return sum;
}

Real BodyContacts::pairs() const {
  Real sum = 0;
  for (const BodyLoad& load : loads_) sum += load.pairs;
  return sum;
}

ContactSum BodyContacts::on_wall(int wall) const {
  Real sums[kWallTerms];
  kernels_->body_wall_sums(views(), originals_, {wall, model_.space.min, subdomain_.period()}, sums);
  return make_wall_contact(sums);
}

}  // namespace scree
