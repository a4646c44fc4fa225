// Which part of the space a random group of particles fills.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"
#include "model/data/names.hpp"
#include "model/derived/generators.hpp"

namespace scree {

// What lies within all that the group's table gives of a box, a cylinder, the inside of a mesh and that of a
// body, at t = 0. Lives no longer than the model.
class FillRegion {
 public:
  // Throws InputError where nothing is given, or what is given has no inside.
  FillRegion(const DeckTable& table, const Model& model, const ModelNames& names);

  // Whether a box alone is given.
  bool is_box() const { return parts_.empty(); }
  // Whether a sphere lies in the region; of a box alone nothing is asked.
  bool holds(Vec3 p, Real radius) const;
  // The box around all of it, within the space unless a box alone is given, and where positions are drawn.
  PackingBox packing(Real gap, std::int64_t tries) const;
  // The part of what positions are drawn from that is of the region and free, by random points; 0: none was
  // found.
  Real share(const IsFree& is_free) const;
  // For messages: "the box (min, max)", "the region (cylinder_radius, mesh)".
  const std::string& name() const { return name_; }

 private:
  void add_box(const DeckTable& table);
  void add_cylinder(const DeckTable& table);
  void add_circle(const DeckTable& table);
  void add_mesh(const DeckTable& table, const Model& model, const ModelNames& names);
  void add_body(const DeckTable& table, const Model& model, const ModelNames& names);
  bool lies_in_box(Vec3 p, Real radius) const;
  void stay_within(Vec3 min, Vec3 max);
  void stay_within_points(const std::vector<Vec3>& points);

  int dimension_;
  Vec3 min_, max_;
  std::vector<std::function<bool(Vec3, Real)>> parts_;
  std::optional<DrawnRegion> drawn_;
  std::string name_;
};

// Whether spheres keep off the planes of the model, but for round-off.
bool is_clear_of_planes(const Model& model, Vec3 p, Real radius);

}  // namespace scree
