#include "model/derived/frames.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/rotation.hpp"
#include "deck/choices.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr Real kUnitLength = 1e-6;  // tolerance of a quaternion's length
constexpr Real kSquare = 1e-6;      // largest cosine between perpendicular axes

Quaternion read_quaternion(const DeckTable& table, const std::string& key) {
  const std::vector<Real>& e = table.reals(key);
  const Quaternion given{e[0], e[1], e[2], e[3]};
  if (!(std::abs(norm(given) - 1) < kUnitLength))
    table.fail(key, fmt::format("must be of length 1, to {:g}; it is {:.9g}", kUnitLength, norm(given)));
  return normalized(given);
}

Quaternion read_axes(const DeckTable& table, const std::string& x_key, const std::string& z_key) {
  if (!table.has(z_key)) table.fail(x_key, fmt::format("needs {} too", z_key));
  const Vec3 z = read_direction(table, z_key);
  if (!table.has(x_key)) return quaternion_of(transposed(frame_about(z)));
  const Vec3 given = read_direction(table, x_key);
  if (!(std::abs(dot(given, z)) <= kSquare))
    table.fail(x_key, fmt::format("must be perpendicular to {}; the cosine between them is {:.3g}, allowed "
                                  "is {:g}",
                                  z_key, dot(given, z), kSquare));
  const Vec3 across = given - dot(given, z) * z, x = (1 / norm(across)) * across;
  return quaternion_of(transposed({x, cross(z, x), z}));
}

}  // namespace

Quaternion read_orientation(const DeckTable& table, const std::string& prefix) {
  const std::string quaternion = prefix + "quaternion", about = prefix + "rotation_axis",
                    angle = prefix + "rotation_angle", x = prefix + "x_axis", z = prefix + "z_axis";
  if (table.has(about) != table.has(angle))
    table.fail(table.has(about) ? about : angle, fmt::format("{} and {} go together", about, angle));
  if (table.has(about) && table.has(quaternion))
    table.fail(quaternion, fmt::format("not used together with {} and {}", about, angle));
  for (const std::string& key : {x, z})
    for (const std::string& other : {quaternion, about})
      if (table.has(key) && table.has(other))
        table.fail(key, fmt::format("not used together with {}", other));
  if (table.has(about)) {
    const Vec3 along = table.vector(about);
    if (norm(along) == 0) table.fail(about, "must not be 0");
    return exponential((table.real(angle) / norm(along)) * along);
  }
  if (table.has(x) || table.has(z)) return read_axes(table, x, z);
  return table.has(quaternion) ? read_quaternion(table, quaternion) : Quaternion{};
}

Vec3 rotated_at_start(const DeckTable& body, Vec3 local) {
  if (body.choice<BodyKind>("kind") == BodyKind::planar) return Rotation(body.real("angle")).turn(local);
  return rotation_matrix(read_orientation(body)) * local;
}

Vec3 read_direction(const DeckTable& table, const std::string& key) {
  const Vec3 along = table.vector(key);
  if (norm(along) == 0) table.fail(key, "must not be 0");
  if (!std::isnormal(norm(along))) table.fail(key, "its length is beyond what a number holds");
  return (1 / norm(along)) * along;
}

Mat3 frame_about(Vec3 axis) {
  const Real a = std::abs(axis.x), b = std::abs(axis.y), c = std::abs(axis.z);
  const Vec3 across = a <= b && a <= c ? Vec3{1, 0, 0} : b <= c ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 y = cross(axis, across), unit = (1 / norm(y)) * y;
  return {cross(unit, axis), unit, axis};
}

Mat3 rotated_frame(const Mat3& frame, Vec3 from, Vec3 to) {
  const Vec3 normal = cross(from, to);
  const Real sine = norm(normal), cosine = dot(from, to);
  const Vec3 turn = sine > 0 ? (std::atan2(sine, cosine) / sine) * normal : Vec3{};
  return frame * transposed(rotation_matrix(exponential(turn)));
}

Real angle_between(Vec3 a, Vec3 b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace scree
