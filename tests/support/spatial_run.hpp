// Spatial mechanisms of tests/reference/spatial, and runs against their solutions.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "physics/spatial_rotation.hpp"
#include "support/multibody_run.hpp"
#include "support/reference_table.hpp"

namespace scree {

inline Body spatial_body(const std::string& name, Real mass, Vec3 inertia, Vec3 position,
                         const Quaternion& orientation = {}) {
  Body body;
  body.name = name, body.kind = BodyKind::spatial;
  body.mass = mass, body.inertia_tensor = {inertia.x, 0, 0, inertia.y, 0, inertia.z};
  body.inertia = std::min({inertia.x, inertia.y, inertia.z});
  body.position = position, body.orientation = orientation;
  return body;
}

// The references' gravity is along z.
inline Model spatial_model(Real hht_alpha) {
  Model model = empty_model();
  model.gravity = {0, 0, -9.81};
  model.integrator.hht_alpha = hht_alpha;
  return model;
}

inline Joint joint_at(JointKind kind, const std::string& name, int first, int second, Vec3 on_first,
                      Vec3 on_second) {
  Joint joint;
  joint.kind = kind, joint.name = name;
  joint.body[0] = first, joint.body[1] = second;
  joint.point[0] = on_first, joint.point[1] = on_second;
  return joint;
}

// Largest differences over all bodies and instants: position [m], rotation [rad], velocity [m/s], angular
// velocity [rad/s], joint forces [N] (0 where the table has none).
struct SpatialErrors {
  Real position = 0, rotation = 0, velocity = 0, spin = 0, force = 0;
};

// Error of forces with columns of their own.
using ForceError = std::function<Real(const ReferenceTable::Row&, const std::vector<Reaction>&)>;

inline SpatialErrors spatial_errors(const Model& model, const std::string& table, Real h, Real from = 0,
                                    Real tolerance = 1e-13, const ForceError& force_error = {}) {
  const ReferenceTable reference("spatial/" + table);
  MultibodyRun run(model, tolerance);
  SpatialErrors errors;
  for (const ReferenceTable::Row& row : reference.rows()) {
    const int steps = static_cast<int>(std::lround((row["t [s]"] - run.time) / h));
    if (steps > 0) run.steps(steps, h);
    if (row["t [s]"] < from) continue;
    const auto numbers = [&](const char* names[3], const std::string& ending) {
      return Vec3{row[names[0] + ending], row[names[1] + ending], row[names[2] + ending]};
    };
    const std::vector<BodyMotion> motion = run.multibody.motion(run.state);
    const std::vector<Reaction> reactions = run.multibody.reactions(run.state, run.time);
    if (force_error) errors.force = std::max(errors.force, force_error(row, reactions));
    for (std::size_t b = 0; b < motion.size(); ++b) {
      const std::string n = std::to_string(b + 1);
      const char *at[] = {"x", "y", "z"}, *v[] = {"vx", "vy", "vz"}, *w[] = {"wx", "wy", "wz"},
                 *f[] = {"Fx", "Fy", "Fz"};
      const Quaternion p{row["e0_" + n], row["e1_" + n], row["e2_" + n], row["e3_" + n]};
      const auto take = [](Real& largest, Real error) { largest = std::max(largest, error); };
      take(errors.position, norm(motion[b].position - numbers(at, n + " [m]")));
      take(errors.rotation, norm(rotation_vector(conjugate(p) * motion[b].orientation)));
      take(errors.velocity, norm(motion[b].velocity - numbers(v, n + " [m/s]")));
      take(errors.spin, norm(motion[b].spin - numbers(w, n + " [rad/s]")));
      if (b < reactions.size() && reference.has("Fx" + n + " [N]"))
        take(errors.force, norm(reactions[b].force - numbers(f, n + " [N]")));
    }
  }
  return errors;
}

inline Model heavy_top(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  model.bodies = {spatial_body("top", 15, {0.234375, 0.46875, 0.234375}, {0, 1, 0})};
  model.bodies[0].spin = {0, 150, -4.61538}, model.bodies[0].velocity = {4.61538, 0, 0};
  model.joints = {joint_at(JointKind::spherical, "tip", kGround, 0, {}, {0, -1, 0})};
  return model;
}

inline Model double_spherical(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  const Quaternion first = exponential({M_PI / 3, 0, 0}), second = exponential({0, -M_PI / 4, 0});
  const Vec3 down{0, 0, -1}, along = rotation_matrix(first) * down, on = rotation_matrix(second) * down;
  model.bodies = {
      spatial_body("upper", 1.2, {0.0365, 0.0380, 0.0017}, Real(0.3) * along, first),
      spatial_body("lower", 0.8, {0.0108, 0.0112, 0.0006}, Real(0.6) * along + Real(0.2) * on, second)};
  Body &upper = model.bodies[0], &lower = model.bodies[1];
  upper.spin = {0.5, -1, 6}, lower.spin = {-2, 1, 4};
  const auto swing = [](const Body& body, Vec3 arm) {
    return rotation_matrix(body.orientation) * cross(body.spin, arm);
  };
  upper.velocity = swing(upper, {0, 0, -0.3});
  lower.velocity = swing(upper, {0, 0, -0.6}) + swing(lower, {0, 0, -0.2});
  model.joints = {joint_at(JointKind::spherical, "pivot", kGround, 0, {}, {0, 0, 0.3}),
                  joint_at(JointKind::spherical, "elbow", 0, 1, {0, 0, -0.3}, {0, 0, 0.2})};
  return model;
}

inline Model chain20(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  for (int i = 0; i < 20; ++i) {
    const Real x = 0.1 * i + 0.05;
    Body link = spatial_body("link." + std::to_string(i), 0.1, {1.1e-5, 8.7e-5, 9.1e-5}, {x, 0, 0});
    link.spin = {2, 0, 1}, link.velocity = {0, x, 0};
    model.bodies.push_back(link);
    model.joints.push_back(joint_at(JointKind::spherical, "joint." + std::to_string(i), i - 1, i,
                                    i == 0 ? Vec3{} : Vec3{0.05, 0, 0}, {-0.05, 0, 0}));
  }
  return model;
}

inline Model free_body(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  model.gravity = {};
  model.bodies = {spatial_body("body", 1, {0.2, 0.4, 0.5}, {})};
  model.bodies[0].spin = {0.01, 10, 0.02}, model.bodies[0].velocity = {1, -2, 0.5};
  return model;
}

// Orientation of a joint's frame with z along `axis` and x across it, in the frame of the body of these
// axes.
inline Quaternion marker_along(Vec3 axis, Vec3 across) {
  return quaternion_of(transposed({across, cross(axis, across), axis}));
}

// The start is the reference's first row.
inline void start_from(Model& model, const std::string& table) {
  const ReferenceTable reference("spatial/" + table);
  const ReferenceTable::Row& row = reference.rows().front();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::string n = std::to_string(b + 1);
    Body& body = model.bodies[b];
    body.position = {row["x" + n + " [m]"], row["y" + n + " [m]"], row["z" + n + " [m]"]};
    body.velocity = {row["vx" + n + " [m/s]"], row["vy" + n + " [m/s]"], row["vz" + n + " [m/s]"]};
    body.spin = {row["wx" + n + " [rad/s]"], row["wy" + n + " [rad/s]"], row["wz" + n + " [rad/s]"]};
    body.orientation = normalized({row["e0_" + n], row["e1_" + n], row["e2_" + n], row["e3_" + n]});
  }
}

inline Model slider_crank_in_space(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  model.bodies = {spatial_body("crank", 0.12, {1e-4, 1e-4, 1e-5}, {}),
                  spatial_body("rod", 0.5, {4e-4, 4e-3, 4e-3}, {}),
                  spatial_body("slider", 2, {1e-4, 1e-4, 1e-4}, {})};
  start_from(model, "slider_crank.csv");
  const Quaternion along_x = marker_along({1, 0, 0}, {0, 1, 0});
  model.joints = {joint_at(JointKind::revolute, "hinge", kGround, 0, {0, 0.1, 0.12}, {0, 0, -0.04}),
                  joint_at(JointKind::spherical, "ball", 0, 1, {0, 0, 0.04}, {-0.15, 0, 0}),
                  joint_at(JointKind::universal, "cross", 2, 1, {}, {0.15, 0, 0}),
                  joint_at(JointKind::translational, "guide", kGround, 2, {}, {})};
  for (const std::size_t j : {0, 3}) model.joints[j].marker[0] = model.joints[j].marker[1] = along_x;
  // The slider's arm, x of its marker, along y; the rod's, y of its marker, along its z.
  model.joints[2].marker[0] = marker_along({0, 0, 1}, {0, 1, 0});
  model.joints[2].marker[1] = quaternion_of(transposed({{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}}));
  return model;
}

// Two gears on revolute joints, the second with a pinion for a rack on a spring.
inline Model gears_in_space(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  model.gravity = {0, -9.81, 0};
  model.bodies = {spatial_body("small", 1.5, {0.004, 0.004, 0.007}, {}),
                  spatial_body("large", 4, {0.07, 0.07, 0.13}, {}), spatial_body("rack", 3, {1, 1, 1}, {})};
  start_from(model, "gears.csv");
  model.joints = {joint_at(JointKind::revolute, "first", kGround, 0, {}, {-0.05, 0, 0}),
                  joint_at(JointKind::revolute, "second", kGround, 1, {0.35, 0, 0}, {}),
                  joint_at(JointKind::translational, "guide", kGround, 2, {0.35, -0.08, 0}, {})};
  model.joints[2].marker[0] = model.joints[2].marker[1] = marker_along({1, 0, 0}, {0, 1, 0});
  model.joint_springs = {{"spring", 2, 400, 0, 0, {}, {}}};
  model.couplers = {{"mesh", {0, 1}, {1, 2.5}}, {"rack", {1, 2}, {-0.08, 1}}};
  return model;
}

// A nut on a screw along (0.6, 0, 0.8).
inline Model screw_in_space(Real hht_alpha) {
  Model model = spatial_model(hht_alpha);
  model.bodies = {spatial_body("nut", 2, {0.012, 0.015, 0.009}, {})};
  Sym3& j = model.bodies[0].inertia_tensor;
  j.xy = 0.001, j.xz = -0.002, j.yz = 0.0015;
  start_from(model, "screw.csv");
  Joint thread = joint_at(JointKind::screw, "thread", kGround, 0, {}, {-0.1, 0, 0});
  thread.marker[0] = marker_along({0.6, 0, 0.8}, {0.8, 0, -0.6}), thread.lead = 0.05;
  model.joints = {thread};
  return model;
}

}  // namespace scree
