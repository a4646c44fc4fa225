#include "model/derived/surface_speeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/rotation.hpp"
#include "mesh/surface_mesh.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/scalar_function.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

// The velocity field of a rigid object: velocity + spin x (x - point).
struct Twist {
  Vec3 point, velocity, spin;  // [m], [m/s], [rad/s]

  Vec3 at(Vec3 x) const { return velocity + cross(spin, x - point); }
  // The twist in a frame with the rotation `turn` and its origin at `origin` in the present frame.
  Twist seen_from(const Quaternion& turn, Vec3 origin) const {
    const Quaternion back = conjugate(turn);
    return {rotated(back, point - origin), rotated(back, velocity), rotated(back, spin)};
  }
};

// Times from 0 to `end` [s] at which a function may have its largest rate: its ends, the middle of a step,
// the first maximum of a sine's rate, and eight times in each segment of a table.
std::vector<Real> telling_times(const TimeFunction& function, Real end) {
  std::vector<Real> times{0, end};
  if (function.kind == TimeFunctionKind::step) times.push_back((function.start + function.end) / 2);
  if (function.kind == TimeFunctionKind::sine && function.frequency > 0) {
    const Real turns = function.phase / (2 * std::numbers::pi_v<Real>);
    times.push_back((std::ceil(2 * turns) / 2 - turns) / function.frequency);
  }
  constexpr int kPieces = 8;
  for (std::size_t k = 1; k < function.times.size(); ++k)
    for (int part = 0; part <= kPieces; ++part)
      times.push_back(function.times[k - 1] + (function.times[k] - function.times[k - 1]) * part / kPieces);
  std::erase_if(times, [&](Real t) { return !(t >= 0 && t <= end); });
  return times;
}

// The time of the largest absolute rate [s].
Real fastest_time(const TimeFunction& function, Real end) {
  const ScalarFunction value(function, "motion", end);
  const std::vector<Real> times = telling_times(function, end);
  return *std::ranges::max_element(times, {}, [&](Real t) { return std::abs(value(t).rate); });
}

Real largest(const TimeFunction& function, Real end) {
  const ScalarFunction value(function, "rate", end);
  Real most = 0;
  for (const Real t : telling_times(function, end)) most = std::max(most, std::abs(value(t).value));
  return most;
}

}  // namespace

Real fastest_rate(const TimeFunction& function, Real end) {
  return std::abs(ScalarFunction(function, "motion", end)(fastest_time(function, end)).rate);
}

namespace {

// Unit normals of the faces at an edge.
std::vector<Vec3> face_normals(const SurfaceMesh& mesh, const MeshFeature& edge) {
  std::vector<Vec3> normals;
  for (Index k = edge.first_test; k < edge.first_test + edge.tests; ++k) {
    const Index part = mesh.tests[static_cast<std::size_t>(k)];
    normals.push_back(mesh.parts[static_cast<std::size_t>(part < 0 ? ~part : part)].normal);
  }
  return normals;
}

// The largest component of v or -v along a normal of an edge: any direction between the normals of its two
// faces, a1 n1 + a2 n2 with a1, a2 >= 0; at an edge of one face, or of many, any direction perpendicular to
// it.
Real along_normals_of(const SurfaceMesh& mesh, const MeshFeature& edge, Vec3 v) {
  constexpr Real kSmooth = 1 - 1e-6;  // cosine above which two faces are taken as one
  const auto vertex = [&](Index k) { return mesh.vertices[static_cast<std::size_t>(k)]; };
  const Vec3 way = vertex(edge.b) - vertex(edge.a), along = (1 / norm(way)) * way;
  const Real beside = norm(v - dot(v, along) * along);
  const std::vector<Vec3> normals = face_normals(mesh, edge);
  if (normals.size() != 2) return beside;
  const Real a = dot(v, normals[0]), b = dot(v, normals[1]), c = dot(normals[0], normals[1]);
  const bool between = c < kSmooth && (a - c * b) * (b - c * a) > 0;
  return between ? beside : std::max(std::abs(a), std::abs(b));
}

// twist: in the mesh's frame.
Real fastest_along_normals(const SurfaceMesh& mesh, const Twist& twist) {
  Real most = 0;
  for (const MeshTriangle& triangle : mesh.triangles)
    for (const Index corner : triangle.vertex)
      most = std::max(most, std::abs(dot(twist.at(mesh.vertices[static_cast<std::size_t>(corner)]),
                                         mesh.parts[static_cast<std::size_t>(triangle.part)].normal)));
  for (const MeshFeature& edge : mesh.features)
    if (edge.b >= 0)
      for (const Index end : {edge.a, edge.b})
        most = std::max(most,
                        along_normals_of(mesh, edge, twist.at(mesh.vertices[static_cast<std::size_t>(end)])));
  return most;
}

// Points at which a plane intersects the edges of the domain's box.
std::vector<Vec3> corners_in_space(const Space& space, Vec3 point, Vec3 normal) {
  const auto corner = [&](unsigned k) {
    return Vec3{k & 1u ? space.max.x : space.min.x, k & 2u ? space.max.y : space.min.y,
                k & 4u ? space.max.z : space.min.z};
  };
  std::vector<Vec3> cuts;
  for (unsigned k = 0; k < 8; ++k)
    for (const unsigned axis : {1u, 2u, 4u}) {
      if ((k & axis) != 0) continue;
      const Vec3 a = corner(k), b = corner(k | axis);
      const Real from = dot(normal, a - point), to = dot(normal, b - point);
      if (from * to <= 0 && from != to) cuts.push_back(a + (from / (from - to)) * (b - a));
    }
  return cuts;
}

// Pose and velocity of a wall at one time.
struct PlacedWall {
  Quaternion turn;
  Twist twist;
};

PlacedWall placed(const Wall& wall, Real end, Real t) {
  PlacedWall now{};
  for (const WallMotion& motion : wall.motions) {
    const ScalarFunction coordinate(motion.coordinate, "wall", end);
    const TimeValue value = coordinate(t);
    const Real change = value.value - coordinate(0).value;
    Twist& twist = now.twist;
    if (motion.kind == WallMotionKind::translation) {
      twist.point += change * motion.axis, twist.velocity += value.rate * motion.axis;
      continue;
    }
    const Quaternion turn = exponential(change * motion.axis);
    const Vec3 arm = rotated(turn, twist.point - motion.point);
    twist = {motion.point + arm, rotated(turn, twist.velocity) + cross(value.rate * motion.axis, arm),
             rotated(turn, twist.spin) + value.rate * motion.axis};
    now.turn = normalized(turn * now.turn);
  }
  return now;
}

Real wall_speed(const Model& model, const Wall& wall, Real t) {
  const PlacedWall now = placed(wall, model.time.end, t);
  if (wall.mesh >= 0)
    return fastest_along_normals(*model.meshes[static_cast<std::size_t>(wall.mesh)].surface,
                                 now.twist.seen_from(now.turn, now.twist.point));
  const Vec3 normal = rotated(now.turn, wall.normal), point = now.twist.point + rotated(now.turn, wall.point);
  Real most = 0;
  for (const Vec3 corner : corners_in_space(model.space, point, normal))
    most = std::max(most, std::abs(dot(now.twist.at(corner), normal)));
  return most;
}

// A single motion of a mesh is fastest at its largest rate. Several motions are evaluated at the largest rate
// of each and in between. So is a plane, whose part in the domain changes as it rotates.
Real wall_speed(const Model& model, const Wall& wall) {
  constexpr int kBetween = 32;
  const Real end = model.time.end;
  std::vector<Real> times;
  for (const WallMotion& motion : wall.motions) times.push_back(fastest_time(motion.coordinate, end));
  for (int k = 0; k <= kBetween && (wall.motions.size() > 1 || wall.mesh < 0); ++k)
    times.push_back(end * k / kBetween);
  Real most = 0;
  for (const Real t : times) most = std::max(most, wall_speed(model, wall, t));
  return most;
}

// Transforms a direction from the global frame to the body's frame at t = 0, and back.
Vec3 in_frame_of(const Model& model, int body, Vec3 direction) {
  if (body == kGround) return direction;
  const Body& of = model.bodies[static_cast<std::size_t>(body)];
  return of.kind == BodyKind::spatial ? rotated(conjugate(of.orientation), direction)
                                      : Rotation(-of.angle).turn(direction);
}
Vec3 global(const Model& model, int body, Vec3 direction) {
  if (body == kGround) return direction;
  const Body& of = model.bodies[static_cast<std::size_t>(body)];
  return of.kind == BodyKind::spatial ? rotated(of.orientation, direction)
                                      : Rotation(of.angle).turn(direction);
}

// The axis along or about which a joint's coordinate moves, in the global frame at t = 0; unit vector.
Vec3 axis_of(const Model& model, const Joint& joint, JointCoordinate coordinate) {
  const bool spatial = std::ranges::any_of(joint.body, [&](int body) {
    return body != kGround && model.bodies[static_cast<std::size_t>(body)].kind == BodyKind::spatial;
  });
  const auto marker = [&](int side, Vec3 axis) {
    return global(model, joint.body[side], rotated(joint.marker[side], axis));
  };
  if (coordinate == JointCoordinate::angle_1) return marker(0, {1, 0, 0});
  if (coordinate == JointCoordinate::angle_2) return marker(1, {0, 1, 0});
  if (coordinate == JointCoordinate::length) {
    const auto place = [&](int side) {
      const int body = joint.body[side];
      const Vec3 centre = body == kGround ? Vec3{} : model.bodies[static_cast<std::size_t>(body)].position;
      return centre + global(model, body, joint.point[side]);
    };
    const Vec3 way = place(1) - place(0);
    return norm(way) > 0 ? (1 / norm(way)) * way : Vec3{1, 0, 0};
  }
  if (spatial) return marker(0, {0, 0, 1});
  return coordinate == JointCoordinate::angle ? Vec3{0, 0, 1} : global(model, joint.body[0], joint.axis);
}

// The largest rate at which a motor drives a joint without load [rad/s, m/s]; 0: it prescribes none.
Real fastest_rate(const Motor& motor, Real end) {
  switch (motor.kind) {
    case MotorKind::speed:
      return largest(motor.rate, end);
    case MotorKind::line:
      return largest(motor.command, end) * motor.free_rate;
    case MotorKind::position:
      return fastest_rate(motor.position, end);
    case MotorKind::effort:
      return 0;
  }
  return 0;
}

// Calls use(joint, coordinate, rate) for all elements that drive a joint at a rate [rad/s, m/s].
template <class Use>
void for_prescribed(const Model& model, const Use& use) {
  const Real end = model.time.end;
  const auto joint = [&](int number) -> const Joint& {
    return model.joints[static_cast<std::size_t>(number)];
  };
  const auto coordinate = [&](const auto& of) {
    return coordinate_of(of.name, joint(of.joint), of.coordinate);
  };
  for (const Driver& driver : model.drivers)
    use(joint(driver.joint), coordinate(driver), fastest_rate(driver.motion, end));
  for (const Motor& motor : model.motors)
    use(joint(motor.joint), coordinate(motor), fastest_rate(motor, end));
}

void take_larger(std::vector<Real>& speeds, int material, Real speed) {
  Real& most = speeds[static_cast<std::size_t>(material)];
  most = std::max(most, speed);
}

// twist: global, at t = 0.
void take_body(const Model& model, int number, const Twist& twist, std::vector<Real>& speeds) {
  const Body& body = model.bodies[static_cast<std::size_t>(number)];
  const Vec3 point = in_frame_of(model, number, twist.point - body.position);
  const Twist own{point, in_frame_of(model, number, twist.velocity), in_frame_of(model, number, twist.spin)};
  for (const Shape& shape : body.shapes) take_larger(speeds, shape.material, norm(own.at(shape.offset)));
  for (const MeshShape& shape : body.meshes) {
    const Twist seen{own.point - shape.offset, own.velocity, own.spin};
    take_larger(speeds, shape.material,
                fastest_along_normals(*model.meshes[static_cast<std::size_t>(shape.mesh)].surface, seen));
  }
}

// The body and those that fixed joints connect to it.
std::vector<int> fixed_together(const Model& model, int body) {
  std::vector<int> group{body};
  for (std::size_t k = 0; k < group.size(); ++k)
    for (const Joint& joint : model.joints) {
      if (joint.kind != JointKind::fixed) continue;
      for (const int side : {0, 1}) {
        const int other = joint.body[1 - side];
        if (joint.body[side] == group[k] && other != kGround &&
            std::ranges::find(group, other) == group.end())
          group.push_back(other);
      }
    }
  return group;
}

void take_driven(const Model& model, const Joint& joint, JointCoordinate coordinate, Real rate,
                 std::vector<Real>& speeds) {
  const Vec3 motion = rate * axis_of(model, joint, coordinate);
  for (const int side : {0, 1}) {
    const int body = joint.body[side];
    if (body == kGround) continue;
    const Vec3 point =
        model.bodies[static_cast<std::size_t>(body)].position + global(model, body, joint.point[side]);
    const Twist twist = is_angle(coordinate) ? Twist{point, {}, motion} : Twist{point, motion, {}};
    for (const int one : fixed_together(model, body)) take_body(model, one, twist, speeds);
  }
}

}  // namespace

std::vector<Real> surface_speeds(const Model& model) {
  std::vector<Real> speeds(static_cast<std::size_t>(model.contact.materials()), 0);
  for (const Wall& wall : model.walls)
    if (wall.moves()) take_larger(speeds, wall.material, wall_speed(model, wall));
  for_prescribed(model, [&](const Joint& joint, JointCoordinate coordinate, Real rate) {
    if (rate > 0) take_driven(model, joint, coordinate, rate, speeds);
  });
  return speeds;
}

}  // namespace scree
