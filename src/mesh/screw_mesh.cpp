#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/mesh_builder.hpp"
#include "mesh/primitives.hpp"
#include "mesh/shape_parts.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// A left-handed screw. Its section at one height consists of the free core and of the flight, a fan of
// `radial_segments` by `sector_segments` patches. Their edges on the flight's faces are so short that the
// patches of a face, which are twisted, are flat to second order. Strips split the core's patches along z in
// the direction in which the sections rotate; the other diagonal would cut off a chord of two segments.
class Screw {
 public:
  explicit Screw(const ScrewShape& shape)
      : shape_(shape),
        rise_(std::abs(shape.pitch)),
        half_sector_(kPi * shape.thickness / rise_),
        parts_(screw_parts(shape)) {}

  TriangleMesh mesh() {
    std::vector<Layer> layers;
    for (Index k = 0; k <= parts_.layers; ++k) layers.push_back(layer(k));
    for (Index k = 0; k < parts_.layers; ++k)
      builder_.strip(contour(layers[k]), contour(layers[k + 1]), true);
    end(layers.front(), false);
    end(layers.back(), true);
    return builder_.take();
  }

 private:
  // Counterclockwise: the free core, the flight's first face outwards, its rim, its second face inwards. The
  // corners belong to core and rim.
  struct Layer {
    Ring core, first_face, rim, second_face;
    Real z, turned;
  };

  Real radius(Index k) const {
    return shape_.core_radius + (shape_.flight_radius - shape_.core_radius) * k / parts_.radial_segments;
  }
  Index vertex_at(Real radius, Real angle, Real z) {
    return builder_.vertex({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  // An arc of so many segments, both ends included.
  Ring arc(Real radius, Real first, Real last, Index segments, Real z) {
    Ring ring;
    for (Index k = 0; k <= segments; ++k)
      ring.push_back(vertex_at(radius, first + (last - first) * k / segments, z));
    return ring;
  }
  Layer layer(Index k) {
    const Real z = shape_.length * (Real(k) / parts_.layers - Real(0.5)), turned = -2 * kPi * z / rise_;
    const Real first = turned - half_sector_, second = turned + half_sector_;
    Layer layer{{}, {}, {}, {}, z, turned};
    layer.core = arc(shape_.core_radius, second, first + 2 * kPi, parts_.core_segments, z);
    for (Index r = 1; r < parts_.radial_segments; ++r)
      layer.first_face.push_back(vertex_at(radius(r), first, z));
    layer.rim = arc(shape_.flight_radius, first, second, parts_.sector_segments, z);
    for (Index r = parts_.radial_segments; --r > 0;)
      layer.second_face.push_back(vertex_at(radius(r), second, z));
    return layer;
  }
  static Ring contour(const Layer& layer) {
    Ring ring = layer.core;
    for (const Ring* part : {&layer.first_face, &layer.rim, &layer.second_face})
      ring.insert(ring.end(), part->begin(), part->end());
    return ring;
  }
  // Vertices across the flight at radius(r), 0 <= r < parts_.radial_segments: new ones between those of the
  // faces.
  Ring across(const Layer& layer, Index r) {
    const Index last = parts_.radial_segments - 1;
    Ring ring{r == 0 ? layer.core.back() : layer.first_face[r - 1]};
    for (Index k = 1; k < parts_.sector_segments; ++k) {
      const Real angle =
          layer.turned + half_sector_ * (2 * k - parts_.sector_segments) / parts_.sector_segments;
      ring.push_back(vertex_at(radius(r), angle, layer.z));
    }
    ring.push_back(r == 0 ? layer.core.front() : layer.second_face[last - r]);
    return ring;
  }
  // The flight's cut and the core's end, seen from +z (up) or -z.
  void end(const Layer& layer, bool up) {
    const Ring foot = across(layer, 0);
    Ring low = foot;
    for (Index r = 1; r <= parts_.radial_segments; ++r) {
      const Ring high = r < parts_.radial_segments ? across(layer, r) : layer.rim;
      up ? builder_.strip(high, low, false) : builder_.strip(low, high, false);
      low = high;
    }
    Ring ring = layer.core;
    ring.insert(ring.end(), foot.begin() + 1, foot.end() - 1);
    const Real z = (up ? 1 : -1) * shape_.core_length / 2;
    if (shape_.core_length > shape_.length) ring = drawn_out(ring, z, up);
    const Index axis = builder_.vertex({0, 0, z});
    builder_.fan(axis, up ? ring : reversed(ring));
  }
  // The core's free end from the ring to height z.
  Ring drawn_out(const Ring& ring, Real z, bool up) {
    Ring far;
    for (const Index v : ring) {
      const Vec3 p = builder_.position(v);
      far.push_back(builder_.vertex({p.x, p.y, z}));
    }
    up ? builder_.strip(ring, far, true) : builder_.strip(far, ring, true);
    return far;
  }

  const ScrewShape& shape_;
  Real rise_;         // of the flight per revolution [m]
  Real half_sector_;  // half angle of the flight's section [rad]
  ScrewParts parts_;
  MeshBuilder builder_;
};

void mirror(TriangleMesh& mesh) {
  for (Vec3& v : mesh.vertices) v.y = -v.y;
  for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
}

}  // namespace

TriangleMesh screw_mesh(const ScrewShape& shape) {
  TriangleMesh mesh = Screw(shape).mesh();
  if (shape.pitch > 0) mirror(mesh);
  return mesh;
}

}  // namespace scree
