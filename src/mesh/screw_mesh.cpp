#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/mesh_builder.hpp"
#include "mesh/primitives.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// An arc of so many segments, both ends included, the whole turned about z.
std::vector<Vec3> arc_points(Real radius, Real first, Real last, Index segments, Real turned) {
  std::vector<Vec3> points;
  for (Index k = 0; k <= segments; ++k) {
    const Real angle = turned + first + (last - first) * k / segments;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return points;
}

class Screw {
 public:
  explicit Screw(const ScrewShape& shape)
      : shape_(shape),
        half_sector_(kPi * shape.thickness / std::abs(shape.pitch)),
        layers_(segments_of(shape.length / std::abs(shape.pitch), 1)),
        core_segments_(segments_of(1 - half_sector_ / kPi, 2)),
        sector_segments_(segments_of(half_sector_ / kPi, 1)) {}

  TriangleMesh mesh() {
    std::vector<Layer> layers;
    for (Index k = 0; k <= layers_; ++k) layers.push_back(layer(k));
    for (Index k = 0; k < layers_; ++k) builder_.strip(contour(layers[k]), contour(layers[k + 1]), true);
    end(layers.front(), false);
    end(layers.back(), true);
    return builder_.take();
  }

 private:
  // Around one height: the free core from the flight's one face to the other, and the flight's rim back.
  struct Layer {
    Ring core, rim;
    Real z, turned;
  };

  Index segments_of(Real turns, Index least) const {
    return std::max(least, static_cast<Index>(std::ceil(shape_.segments * turns)));
  }
  Layer layer(Index k) {
    const Real z = shape_.length * (Real(k) / layers_ - Real(0.5)), turned = 2 * kPi * z / shape_.pitch;
    const auto core =
        arc_points(shape_.core_radius, half_sector_, 2 * kPi - half_sector_, core_segments_, turned);
    const auto rim = arc_points(shape_.flight_radius, -half_sector_, half_sector_, sector_segments_, turned);
    return {builder_.ring(core, z), builder_.ring(rim, z), z, turned};
  }
  static Ring contour(const Layer& layer) {
    Ring ring = layer.core;
    ring.insert(ring.end(), layer.rim.begin(), layer.rim.end());
    return ring;
  }
  // The flight's cut and the core's end, seen from +z (up) or -z.
  void end(const Layer& layer, bool up) {
    std::vector<Vec3> under =
        arc_points(shape_.core_radius, -half_sector_, half_sector_, sector_segments_, layer.turned);
    under = {under.begin() + 1, under.end() - 1};
    const Ring hidden = builder_.ring(under, layer.z);
    Ring foot{layer.core.back()};
    foot.insert(foot.end(), hidden.begin(), hidden.end());
    foot.push_back(layer.core.front());
    if (up) {
      builder_.strip(layer.rim, foot, false);
    } else {
      builder_.strip(foot, layer.rim, false);
    }
    Ring ring = layer.core;
    ring.insert(ring.end(), hidden.begin(), hidden.end());
    const Real z = (up ? 1 : -1) * shape_.core_length / 2;
    if (shape_.core_length > shape_.length) ring = drawn_out(ring, z, up);
    const Index axis = builder_.vertex({0, 0, z});
    builder_.fan(axis, up ? ring : reversed(ring));
  }
  // The core's free end from the ring to height z.
  Ring drawn_out(const Ring& ring, Real z, bool up) {
    Ring far;
    for (const Index v : ring) {
      const Vec3 p = builder_.place(v);
      far.push_back(builder_.vertex({p.x, p.y, z}));
    }
    if (up) {
      builder_.strip(ring, far, true);
    } else {
      builder_.strip(far, ring, true);
    }
    return far;
  }

  const ScrewShape& shape_;
  Real half_sector_;  // [rad], of the flight's section
  Index layers_, core_segments_, sector_segments_;
  MeshBuilder builder_;
};

}  // namespace

TriangleMesh screw_mesh(const ScrewShape& shape) { return Screw(shape).mesh(); }

}  // namespace scree
