#include "run/population/birth_positions.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "mesh/inside.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/frames.hpp"

namespace scree {
namespace {

Vec3 within(CounterRandom& random, Vec3 min, Vec3 max, bool planar) {
  const Real x = random.uniform(min.x, max.x), y = random.uniform(min.y, max.y);
  return {x, y, planar ? 0 : random.uniform(min.z, max.z)};
}

bool is_below(Vec3 a, Vec3 b, bool planar) { return a.x <= b.x && a.y <= b.y && (planar || a.z <= b.z); }

}  // namespace

BirthPositions::BirthPositions(const Model& model, const Inserter& inserter,
                               std::span<const BodyMotion> motion)
    : model_(model), inserter_(inserter), carrier_(model, inserter.carrier, motion) {}

std::optional<Vec3> BirthPositions::point_on_face(CounterRandom& random, Real radius) const {
  const BirthRegion& region = inserter_.region;
  const bool planar = model_.space.dimension == 2;
  const Real u = random.uniform(-1, 1), v = random.uniform(-1, 1);
  const Vec3 a = region.half_side[0], b = region.half_side[1];
  if (region.radius > 0 && !(u * u + v * v <= 1)) return {};
  const auto inner = [radius](Vec3 side) { return std::max(1 - radius / norm(side), Real(0)); };
  return region.center + (u * inner(a)) * a + (planar ? Vec3{} : (v * inner(b)) * b);
}

// At t = 0, in the global frame.
std::optional<Vec3> BirthPositions::point(CounterRandom& random, Real radius) const {
  const BirthRegion& region = inserter_.region;
  const bool planar = model_.space.dimension == 2;
  const Vec3 r{radius, radius, planar ? 0 : radius};
  switch (region.kind) {
    case InserterKind::box: {
      const Vec3 low = region.min + r, high = region.max - r;
      if (!is_below(low, high, planar)) return {};
      return within(random, low, high, planar);
    }
    case InserterKind::sphere: {
      const Real free = region.radius - radius;
      if (!(free >= 0)) return {};
      const Vec3 d = within(random, Vec3{-free, -free, -free}, Vec3{free, free, free}, planar);
      return dot(d, d) <= free * free ? std::optional(region.center + d) : std::nullopt;
    }
    case InserterKind::cylinder: {
      const Vec3 along = region.ends[1] - region.ends[0];
      const Real length = norm(along), free = region.radius - radius;
      if (!(free >= 0 && length >= 2 * radius)) return {};
      const Mat3 frame = frame_about((1 / length) * along);
      const Real s = random.uniform(radius, length - radius);
      const Real u = random.uniform(-free, free), v = random.uniform(-free, free);
      if (!(u * u + v * v <= free * free)) return {};
      return region.ends[0] + s * frame.z + u * frame.x + v * frame.y;
    }
    case InserterKind::mesh: {
      const Vec3 p = within(random, region.min + r, region.max - r, planar);
      MeshView mesh = model_.meshes[as_size(region.mesh)].surface->view();
      mesh.sheet = false;
      return contains_sphere(mesh, region.mesh_axes * (p - region.mesh_origin), radius) ? std::optional(p)
                                                                                        : std::nullopt;
    }
    case InserterKind::face:
      return point_on_face(random, radius);
  }
  return {};
}

std::optional<Birth> BirthPositions::draw(CounterRandom random, Real radius, Real elapsed) const {
  const std::optional<Vec3> at = point(random, radius);
  if (!at) return {};
  Birth birth{*at, inserter_.velocity};
  const Real bound = inserter_.random_velocity;
  if (bound > 0)
    birth.velocity +=
        within(random, Vec3{-bound, -bound, -bound}, Vec3{bound, bound, bound}, model_.space.dimension == 2);
  Vec3 of_carrier;
  if (inserter_.carrier != kGround) {
    birth.position = carrier_.point(birth.position);
    birth.velocity = carrier_.direction(birth.velocity);
    of_carrier = carrier_.velocity(birth.position);
  }
  // From the face on the particle falls freely. The face was behind by the carrier's motion since then, and
  // the particle has moved with the carrier's velocity in addition to its own: the two cancel.
  birth.position += elapsed * (birth.velocity + (elapsed / 2) * model_.gravity);
  birth.velocity += of_carrier + elapsed * model_.gravity;
  return birth;
}

}  // namespace scree
