#include "run/record/mesh_surfaces.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/mat3.hpp"
#include "dem/reports/triangle_works.hpp"
#include "mesh/surface_mesh.hpp"
#include "partition/subdomain.hpp"

namespace scree {
namespace {

Real area(const SurfaceMesh& mesh, const MeshTriangle& triangle) {
  const Vec3 a = mesh.vertices[triangle.vertex[0]];
  return Real(0.5) *
         norm(cross(mesh.vertices[triangle.vertex[1]] - a, mesh.vertices[triangle.vertex[2]] - a));
}

// Length of a 2D segment, from one of its triangles, without the extrusion along z.
Real length(const SurfaceMesh& mesh, const MeshTriangle& triangle) {
  const auto along = [&](int i, int j) {
    Vec3 edge = mesh.vertices[triangle.vertex[j]] - mesh.vertices[triangle.vertex[i]];
    edge.z = 0;
    return norm(edge);
  };
  return std::max(along(0, 1), along(1, 2));
}

}  // namespace

MeshSurfaces::MeshSurfaces(const Model& model) : model_(model) {
  const SurfaceSet surfaces(model);
  for (Index s = 0; s < surfaces.placed(); ++s) {
    const Surface& of = surfaces.at(s);
    const int wall = surfaces.is_on_body(s) ? -1 : static_cast<int>(surfaces.number_of(s));
    if (of.kind == SurfaceKind::mesh)
      add({s, of.parent, wall, of.material, of.point, 0, 0, nullptr}, of.mesh);
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const MeshShape& drawn : model.bodies[b].drawn_meshes)
      add({-1, as_index(b), -1, drawn.material, drawn.offset, 0, 0, nullptr}, drawn.mesh);
}

void MeshSurfaces::add(Part part, int mesh) {
  part.mesh = model_.meshes[as_size(mesh)].surface.get();
  part.first_point = points_, part.first_triangle = triangles_;
  points_ += part.mesh->vertices.size(), triangles_ += part.mesh->triangles.size();
  parts_.push_back(part);
}

SeriesTriangles MeshSurfaces::triangles() const {
  SeriesTriangles all;
  all.fields.emplace();
  for (const SurfaceField field : model_.output.surface_fields) all.fields->push_back(word_of(field));
  all.corners.resize(3 * triangles_);
  all.numbers = {
      {"surface", "mesh of a body or a wall, counted from 0 in this order", {}},
      {"body", "body that the mesh belongs to, counted from 0 in the deck's order; -1: a wall", {}},
      {"wall", "wall that the mesh belongs to, counted from 0 in the deck's order; -1: a body", {}},
      {"material", "material, counted from 0 in the deck's order; -1: none, no contact detection", {}},
      {"triangle", "number of the triangle in its file or shape, counted from 0", {}}};
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const Part& part = parts_[p];
    const int of_part[] = {as_index(p), part.wall < 0 ? part.parent : -1, part.wall, part.material};
    for (std::size_t t = 0; t < part.mesh->triangles.size(); ++t) {
      const auto row = part.first_triangle + as_size(part.mesh->original[t]);
      for (std::size_t k = 0; k < 3; ++k)
        all.corners[3 * row + k] =
            static_cast<std::int64_t>(part.first_point) + part.mesh->triangles[t].vertex[k];
      for (std::size_t k = 0; k < 4; ++k) all.numbers[k].values.push_back(of_part[k]);
      all.numbers[4].values.push_back(as_index(t));
    }
  }
  return all;
}

// Positions of the vertices in the periodic box. The mesh is shifted as a whole, so that its centre lies in
// the box.
void MeshSurfaces::place(const Part& part, const BodyMotion& parent, Vec3* position) const {
  const Mat3 axes = rotation_matrix(orientation(parent));
  const Vec3 point = point_motion(parent, part.point).position,
             middle = point + axes * (Real(0.5) * (part.mesh->box.min + part.mesh->box.max));
  ImageCount unused;
  const Vec3 shift = Subdomain(model_.space).wrap(middle, unused) - middle;
  for (const Vec3 vertex : part.mesh->vertices) *position++ = point + axes * vertex + shift;
}

// Divides the values of triangles by their areas. In 2D two consecutive triangles form a segment: both get
// the sum of the two over the segment's length.
template <class T>
void MeshSurfaces::spread(std::vector<T>& values) const {
  if (values.empty()) return;
  for (const Part& part : parts_)
    for (std::size_t t = 0; t < part.mesh->triangles.size(); ++t) {
      const MeshTriangle& triangle = part.mesh->triangles[t];
      const auto number = as_size(part.mesh->original[t]);
      T& value = values[part.first_triangle + number];
      if (model_.space.dimension == 3)
        value = 1 / area(*part.mesh, triangle) * value;
      else if (number % 2 == 0)
        value = values[part.first_triangle + number + 1] =
            1 / length(*part.mesh, triangle) * (value + values[part.first_triangle + number + 1]);
    }
}

void MeshSurfaces::take_works(const std::vector<std::int64_t>& works, Sample& sample) const {
  const std::vector<TriangleWorkValues> values = work_values(works);
  const auto show = [&](SurfaceField field, std::vector<Real>& to, Real TriangleWorkValues::*value) {
    if (!model_.output.shows(field)) return;
    to.resize(triangles_);
    for (const Part& part : parts_)
      for (std::size_t t = 0; part.surface >= 0 && t < part.mesh->triangles.size(); ++t) {
        const std::size_t row = part.first_triangle + as_size(part.mesh->original[t]);
        to[row] = values[row].*value;
      }
  };
  show(SurfaceField::impact_work, sample.impact_work, &TriangleWorkValues::impact);
  show(SurfaceField::sliding_work, sample.sliding_work, &TriangleWorkValues::sliding);
  show(SurfaceField::wear_depth, sample.wear_depth, &TriangleWorkValues::worn);
  spread(sample.wear_depth);
}

MeshSurfaces::Sample MeshSurfaces::sample(std::span<const BodyMotion> motion,
                                          std::span<const TriangleLoad> loads,
                                          const std::vector<std::int64_t>& works) const {
  Sample sample{};
  sample.position.resize(points_);
  if (model_.output.shows(SurfaceField::pressure)) sample.pressure.resize(triangles_);
  if (model_.output.shows(SurfaceField::shear)) sample.shear.resize(triangles_);
  take_works(works, sample);
  for (const Part& part : parts_)
    place(part, motion[as_size(part.parent)], sample.position.data() + part.first_point);
  for (const TriangleLoad& load : loads) {
    const auto part = std::ranges::find(parts_, load.surface, &Part::surface);
    const SurfaceMesh& mesh = *part->mesh;
    const auto t = as_size(load.triangle);
    const std::size_t row = part->first_triangle + as_size(mesh.original[t]);
    if (!sample.pressure.empty()) sample.pressure[row] = load.normal;
    if (!sample.shear.empty()) sample.shear[row] = load.tangential;
  }
  spread(sample.pressure), spread(sample.shear);
  return sample;
}

}  // namespace scree
