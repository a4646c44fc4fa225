// The region of the domain that a random group of particles fills.
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

// The intersection of the box, the cylinder, the inside of a mesh and the inside of a body that the group's
// table gives, at t = 0. Must not outlive the model.
class FillRegion {
 public:
  // Throws InputError where no region is given, or where it has no inside.
  FillRegion(const DeckTable& table, const Model& model, const ModelNames& names);

  // Whether only a box is given.
  bool is_box() const { return parts_.empty(); }
  // Whether a sphere is inside the region; not evaluated for a plain box.
  bool holds(Vec3 p, Real radius) const;
  // The bounding box, within the domain unless the region is a plain box, and the region for drawing
  // positions.
  PackingBox packing(Real gap, std::int64_t tries) const;
  // The fraction of the drawing region that is inside the region and free, estimated with random points; 0:
  // none found.
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

// A closed mesh of the deck whose inside may hold particles, at t = 0.
struct ClosedMesh {
  int mesh = -1;       // index into Model::meshes
  int body = kGround;  // that has it
  Vec3 offset;         // of its origin in the body's frame, or in the global one [m]
  Vec3 min, max;       // bounding box in the global frame [m]
  Real volume = 0;     // [m^3]
};
// The mesh of the table's keys mesh and, where it has one, body. Throws InputError where the mesh is open or
// its inside is matter.
ClosedMesh closed_mesh(const DeckTable& table, const Model& model, const ModelNames& names);

// Whether spheres do not overlap the planes of the model, except for round-off.
bool is_clear_of_planes(const Model& model, Vec3 p, Real radius);

}  // namespace scree
