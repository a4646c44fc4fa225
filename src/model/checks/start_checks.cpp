// Checks of the start positions and of the step size.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/rotation.hpp"
#include "mesh/hull_corners.hpp"
#include "model/checks/deck_checks.hpp"
#include "model/checks/explicit_step.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/frames.hpp"
#include "model/derived/mesh_corners.hpp"
#include "model/derived/point_bins.hpp"
#include "model/derived/posed_meshes.hpp"
#include "model/derived/shape_positions.hpp"
#include "model/derived/space_box.hpp"
#include "model/derived/touching.hpp"
#include "physics/step_limits.hpp"

namespace scree {

namespace {

std::string point_text(const Space& space, Vec3 p) {
  return space.dimension == 2 ? fmt::format("({}, {})", p.x, p.y)
                              : fmt::format("({}, {}, {})", p.x, p.y, p.z);
}

// Numbering of items: particles by their ids, then shapes, then walls, then meshes of bodies.
class ItemNames {
 public:
  explicit ItemNames(const Model& model) : model_(model), particles_(model.particles.totals.at_start) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      body_.insert(body_.end(), model.bodies[b].shapes.size(), static_cast<int>(b));
      for (const MeshShape& shape : model.bodies[b].meshes) meshes_.emplace_back(b, shape.mesh);
    }
  }
  // Body of a shape; kGround for a particle.
  int body(std::int64_t number) const {
    return number < particles_ ? kGround : body_[static_cast<std::size_t>(number - particles_)];
  }
  std::int64_t first_wall() const { return particles_ + std::ssize(body_); }
  std::int64_t first_mesh() const { return first_wall() + std::ssize(model_.walls); }
  std::string name(std::int64_t number) const {
    if (number < particles_) return fmt::format("particle {}", number);
    if (number < first_wall())
      return fmt::format("body \"{}\"", model_.bodies[static_cast<std::size_t>(body(number))].name);
    if (number < first_mesh())
      return fmt::format("wall \"{}\"", model_.walls[static_cast<std::size_t>(number - first_wall())].name);
    return fmt::format("body \"{}\"", model_.bodies[meshes_[mesh_number(number)].first].name);
  }
  bool is_particle(std::int64_t number) const { return number < particles_; }
  // Index into Model::meshes; -1 where the item is not a mesh.
  int mesh(std::int64_t number) const {
    if (number < first_wall()) return -1;
    if (number < first_mesh()) return model_.walls[static_cast<std::size_t>(number - first_wall())].mesh;
    return meshes_[mesh_number(number)].second;
  }
  // "its shape 2 (from 0)", "its mesh "tooth"": the part of a body with several parts; otherwise "".
  std::string part(std::int64_t number) const {
    if (number < particles_) return "";
    if (number < first_wall()) {
      const auto first = std::ranges::find(body_, body(number)) - body_.begin();
      const bool alone = model_.bodies[static_cast<std::size_t>(body(number))].shapes.size() == 1;
      return alone ? "its shape" : fmt::format("its shape {} (from 0)", number - particles_ - first);
    }
    if (number < first_mesh()) return "";
    return fmt::format("its mesh \"{}\"", model_.meshes[static_cast<std::size_t>(mesh(number))].name);
  }

 private:
  std::size_t mesh_number(std::int64_t number) const {
    return static_cast<std::size_t>(number - first_mesh());
  }

  const Model& model_;
  std::int64_t particles_;
  std::vector<int> body_;  // for each shape
  // For each mesh of a body: the body, and the index into Model::meshes.
  std::vector<std::pair<std::size_t, int>> meshes_;
};

constexpr Real kRoundOff = 1e-9;  // of exact contact between neighbours

// The largest relative overlap so far, by the smaller radius; of equal ones the first by number. Also the
// number of overlaps.
struct Overlaps {
  Real limit;  // the largest allowed overlap
  Real ratio = 0;
  std::int64_t first = 0, second = 0;
  std::int64_t count = 0, above_limit = 0;  // counts of this rank

  void meet(Real other, std::int64_t a, std::int64_t b, bool is_own = true) {
    if (other > ratio || (other == ratio && ratio > 0 && std::pair(b, a) < std::pair(second, first)))
      ratio = other, first = a, second = b;
    if (!is_own) return;
    count += other > kRoundOff;
    above_limit += other > limit;
  }
};

// Combines the overlaps of all ranks.
Overlaps overlaps_of_all(const Overlaps& own, const Share& share) {
  constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  Overlaps all{own.limit, share.max(own.ratio)};
  all.second = share.min(own.ratio == all.ratio ? own.second : kNone);
  all.first = share.min(own.ratio == all.ratio && own.second == all.second ? own.first : kNone);
  all.count = share.sum(own.count), all.above_limit = share.sum(own.above_limit);
  return all;
}

// This rank's particles; the last rank also has the shapes.
std::vector<StartItem> collect_items(const Model& model, const Share& share) {
  std::vector<StartItem> items;
  const ParticleSet& particles = model.particles;
  items.reserve(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    items.push_back({particles.position[i], particles.radius[i],
                     particles.first_id + static_cast<std::int64_t>(i), particles.material[i]});
  std::int64_t number = particles.totals.at_start;
  for (std::size_t b = 0; b < model.bodies.size() && share.rank() == share.size() - 1; ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      items.push_back({to_global_point(model, static_cast<int>(b), shape.offset), shape.radius, number++,
                       shape.material});
  return items;
}

// name: of the object that starts at p, outside the domain.
std::string outside_text(const Space& space, const std::string& name, Vec3 p) {
  const auto text = [&](Vec3 a) { return point_text(space, a); };
  const Box allowed = start_box(space);
  const Vec3 below = allowed.min - p, above = p - allowed.max;
  const Real beyond[] = {below.x, above.x, below.y, above.y, below.z, above.z};
  std::string sides;
  for (std::size_t side = 0; side < std::size(beyond); ++side)
    if (beyond[side] > 0)
      sides += fmt::format("{} {}", sides.empty() ? ", beyond" : " and", kSideNames[side]);
  return fmt::format("{} starts at {}, outside the space from {} to {}{}", name, text(p), text(space.min),
                     text(space.max), sides);
}

// The deck's table of the particle's group.
const DeckTable& group_of(const DeckTable& deck, const Model& model, GlobalId id) {
  const GlobalId ids[] = {id};
  return deck.tables("particles")[static_cast<std::size_t>(groups_of(model.particles, ids).front())];
}

void check_particles_inside(const DeckTable& deck, const Model& model) {
  const Box allowed = start_box(model.space);
  for (std::size_t i = 0; i < model.particles.size(); ++i) {
    const Vec3 p = model.particles.position[i];
    if (allowed.inside(p)) continue;
    const GlobalId id = model.particles.first_id + static_cast<GlobalId>(i);
    throw InputError(fmt::format("{}: {}", group_of(deck, model, id).label(),
                                 outside_text(model.space, fmt::format("particle {}", id), p)));
  }
}

// Bounding box of all items; there is at least one.
Box box_around(const std::vector<StartItem>& items) {
  Box box{items.front().position, items.front().position};
  for (const StartItem& item : items) {
    const Vec3 p = item.position;
    box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
    box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
  }
  return box;
}

// reach: two items farther apart than this do not overlap [m].
void find_pair_overlaps(const Model& model, const std::vector<StartItem>& items, Real reach,
                        Overlaps& overlaps) {
  if (items.empty()) return;
  const ItemNames names(model);
  const TouchRule rule(model);
  const Box box = box_around(items);
  const SortedBins bins(PointCells(box.min, box.max, reach, items.size()), items);
  for (const Vec3 shift : image_shifts(periods_of(model.space))) {
    for (const StartItem& item : bins.items()) {
      const Vec3 p = item.position + shift;
      if (!box.is_within(p, reach)) continue;
      bins.for_near(p, [&](const StartItem& other) {
        const Vec3 apart = p - other.position;
        const Real touching = item.radius + other.radius;
        if (other.number >= item.number || !(dot(apart, apart) < touching * touching)) return;
        const Real ratio = (touching - norm(apart)) / std::min(item.radius, other.radius);
        if (ratio > kRoundOff && model.contact.law(item.material, other.material).acts() &&
            rule.may_touch(names.body(item.number), names.body(other.number)))
          overlaps.meet(ratio, other.number, item.number, item.is_own);
      });
    }
  }
}

void find_wall_overlaps(const Model& model, const std::vector<StartItem>& items, Overlaps& overlaps) {
  const std::int64_t first_wall = ItemNames(model).first_wall();
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const Wall& wall = model.walls[w];
    if (wall.mesh >= 0) continue;
    for (const StartItem& item : items) {
      if (!model.contact.law(item.material, wall.material).acts()) continue;
      const Real overlap = item.radius - dot(wall.normal, item.position - wall.point);
      overlaps.meet(overlap / item.radius, item.number, first_wall + static_cast<std::int64_t>(w));
    }
  }
}

void find_mesh_overlaps(const Model& model, const std::vector<StartItem>& items, Overlaps& overlaps) {
  const ItemNames names(model);
  const PosedMeshes meshes(model);
  const TouchRule rule(model);
  std::int64_t of_bodies = names.first_mesh();
  for (const PosedMesh& mesh : meshes.all()) {
    const std::int64_t number = mesh.wall < 0 ? of_bodies++ : names.first_wall() + mesh.wall;
    for (const StartItem& item : items)
      if (rule.may_touch(names.body(item.number), mesh.body) &&
          model.contact.law(item.material, mesh.material).acts())
        overlaps.meet(mesh.overlap(item.position, item.radius) / item.radius, item.number, number);
  }
}

// Finds overlaps of the vertices of bodies' meshes with planes, relative to the meshes' effective radii.
void find_corner_overlaps(const Model& model, Overlaps& overlaps) {
  const ItemNames names(model);
  std::int64_t number = names.first_mesh();
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& shape : model.bodies[b].meshes) {
      const std::int64_t of_mesh = number++;
      if (!touches_planes(model, b, shape)) continue;
      const HullCorners& hull = *model.meshes[static_cast<std::size_t>(shape.mesh)].corners;
      for (std::size_t w = 0; w < model.walls.size(); ++w) {
        const Wall& wall = model.walls[w];
        if (wall.mesh >= 0 || !model.contact.law(shape.material, wall.material).acts()) continue;
        Real deepest = 0;
        for (const Vec3 corner : hull.corners) {
          const Vec3 at = in_periodic_box(model.space,
                                          to_global_point(model, static_cast<int>(b), shape.offset + corner));
          deepest = std::max(deepest, -dot(wall.normal, at - wall.point));
        }
        overlaps.meet(deepest / hull.radius, of_mesh, names.first_wall() + static_cast<std::int64_t>(w));
      }
    }
}

// The particles and shapes with these numbers, on all ranks.
std::vector<StartItem> items_of(const Model& model, const Share& share,
                                std::initializer_list<std::int64_t> numbers) {
  std::vector<StartItem> items = collect_items(model, share);
  std::erase_if(
      items, [&](const StartItem& item) { return std::ranges::find(numbers, item.number) == numbers.end(); });
  return share.all_gather(std::move(items));
}

// "; particle 3: of particles.grains, at (0.1, 0.2), radius 0.05 m"; "" for a plane.
std::string item_text(const DeckTable& deck, const Model& model, const std::vector<StartItem>& items,
                      std::int64_t number) {
  const ItemNames names(model);
  const auto item = std::ranges::find(items, number, &StartItem::number);
  std::string text =
      names.is_particle(number) ? "of " + group_of(deck, model, number).path() : names.part(number);
  if (item != items.end())
    text += fmt::format(" at {}, radius {:.6g} m", point_text(model.space, item->position), item->radius);
  return text.empty() ? "" : fmt::format("; {}: {}", names.name(number), text);
}

// A note about an item inside a closed mesh; otherwise "".
std::string inside_text(const DeckTable& deck, const Model& model, const Overlaps& overlaps) {
  const ItemNames names(model);
  const int mesh = names.mesh(overlaps.second);
  // Outside the mesh the overlap is at most the radius.
  if (mesh < 0 || names.mesh(overlaps.first) >= 0 || !(overlaps.ratio > 1)) return "";
  const DeckTable& table = deck.tables("meshes")[static_cast<std::size_t>(mesh)];
  const std::string finding = fmt::format("; the centre of {} is inside the solid that mesh \"{}\" encloses",
                                          names.name(overlaps.first), table.text("name"));
  if (model.space.dimension == 2)  // a closed line
    return finding + ": without closed = true, and with the first point again at the end, it is a container";
  if (!table.has("file")) return finding;
  return finding +
         fmt::format(": sheet = true in {} makes it a container, touched from inside, too", table.path());
}

}  // namespace

void check_bodies_inside(const DeckTable& deck, const Space& space) {
  const Box allowed = start_box(space);
  for (const DeckTable& table : deck.tables("bodies")) {
    const bool row = table.has("count");
    const std::int64_t count = row ? table.integer("count") : 1;
    const Vec3 first = table.vector("position"), spacing = table.vector("spacing");
    for (const DeckTable& shape : table.tables("shapes")) {
      if (!collides(table, shape)) continue;
      for (const Vec3 corner : ShapePositions(shape, space.dimension).corners()) {
        const Vec3 offset = rotated_at_start(table, corner);
        for (std::int64_t i = 0; i < count; ++i) {
          const Vec3 p = first + static_cast<Real>(i) * spacing + offset;
          if (allowed.inside(p)) continue;
          const std::string& name = table.text("name");
          const std::string body = row ? fmt::format("{}.{}", name, i) : name;
          table.fail("position", outside_text(space, fmt::format("a shape of body \"{}\"", body), p));
        }
      }
    }
  }
}

void check_start_positions(const DeckTable& deck, const Model& model, const Share& share, Log& log) {
  share.collectively([&] { check_particles_inside(deck, model); });
  std::vector<StartItem> items = collect_items(model, share);
  // As in a run: a particle may start many periods outside the domain.
  for (StartItem& item : items) item.position = in_periodic_box(model.space, item.position);
  const DeckTable& contact = deck.table("contact");
  const Real limit = contact.real("max_start_overlap");
  Overlaps own{limit};
  find_wall_overlaps(model, items, own);
  if (share.rank() == 0) find_corner_overlaps(model, own);
  warn_of_meshes_across(model, log);
  find_mesh_overlaps(model, items, own);
  const Real reach = 2 * radius_range(model).largest;
  items = share.distribute_by_boxes(std::move(items), model.space, reach);
  share.collectively([&] { find_pair_overlaps(model, items, reach, own); });
  const Overlaps all = overlaps_of_all(own, share);
  if (all.ratio <= kRoundOff) return;
  const ItemNames names(model);
  // In other overlaps the second item is a mesh, if one is.
  const bool on_corners = all.first >= names.first_mesh();
  const std::string finding = fmt::format(
      "{} and {} overlap at t = 0 by {:.6g} of the {}", names.name(all.first), names.name(all.second),
      all.ratio, on_corners ? "radius that the mesh counts with on planes" : "smaller radius");
  const std::vector<StartItem> both = items_of(model, share, {all.first, all.second});
  const std::string details = item_text(deck, model, both, all.first) +
                              item_text(deck, model, both, all.second) + inside_text(deck, model, all);
  if (all.ratio > limit)
    contact.fail(
        "max_start_overlap",
        fmt::format(
            "{}; allowed: at most {}{}{}", finding, limit,
            all.count == 1 ? "" : fmt::format("; of {} overlaps {} are above it", all.count, all.above_limit),
            details));
  log.warning(finding + (all.count == 1 ? "" : fmt::format(", the largest of {} overlaps", all.count)) +
              details);
}

}  // namespace scree
