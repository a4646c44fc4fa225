// Words that others use for what the deck has under another name.
#pragma once

#include <array>
#include <string_view>

namespace scree {

struct Synonym {
  std::string_view said;  // in small letters
  std::string_view meant;
};

// Of a choice. Of several for one word the first that the choice has is meant.
inline constexpr auto kWordSynonyms = std::to_array<Synonym>({
    {"slider", "translational"},
    {"prismatic", "translational"},
    {"hinge", "revolute"},
    {"pin", "revolute"},
    {"ball", "spherical"},
    {"ball", "sphere"},
    {"weld", "fixed"},
    {"rigid", "fixed"},
    {"cardan", "universal"},
    {"hooke", "universal"},
    {"helical", "screw"},
    {"auger", "screw"},
    {"tube", "pipe"},
    {"bunker", "hopper"},
    {"silo", "hopper"},
    {"cuboid", "box"},
    {"stl", "file"},
    {"obj", "file"},
    {"ply", "file"},
    {"grid", "lattice"},
    {"explicit", "velocity-verlet"},
    {"verlet", "velocity-verlet"},
    {"implicit", "hht"},
    {"cyclic", "periodic"},
    {"closed", "wall"},
    {"delete", "remove"},
    {"servo", "position"},
    {"servo", "length"},
});

// Of keys, by their paths; likewise for other tables that have a key of this name.
inline constexpr auto kKeySynonyms = std::to_array<Synonym>({
    {"mu", "contact.pairs.friction"},
    {"mu", "joint_frictions.friction_coefficient"},
    {"friction_coefficient", "contact.pairs.friction"},
    {"e", "contact.pairs.restitution"},
    {"cor", "contact.pairs.restitution"},
    {"restitution_coefficient", "contact.pairs.restitution"},
    {"coefficient_of_restitution", "contact.pairs.restitution"},
    {"k", "contact.pairs.stiffness"},
    {"kn", "contact.pairs.stiffness"},
    {"normal_stiffness", "contact.pairs.stiffness"},
    {"kt", "contact.pairs.tangential_stiffness"},
    {"c", "contact.pairs.damping"},
    {"cn", "contact.pairs.damping"},
    {"mu_r", "contact.pairs.rolling_friction"},
    {"rolling_resistance", "contact.pairs.rolling_friction"},
    {"e", "materials.young_modulus"},
    {"young", "materials.young_modulus"},
    {"youngs_modulus", "materials.young_modulus"},
    {"elastic_modulus", "materials.young_modulus"},
    {"nu", "materials.poisson_ratio"},
    {"poisson", "materials.poisson_ratio"},
    {"poissons_ratio", "materials.poisson_ratio"},
    {"rho", "materials.density"},
    {"g", "gravity"},
    {"gravity_vector", "gravity"},
    {"domain", "space"},
    {"dt", "time.step"},
    {"timestep", "time.step"},
    {"time_step", "time.step"},
    {"dt_min", "time.min_step"},
    {"dt_max", "time.max_step"},
    {"t_end", "time.end"},
    {"end_time", "time.end"},
    {"duration", "time.end"},
    {"dt_output", "output.snapshot_interval"},
    {"output_interval", "output.snapshot_interval"},
    {"output_directory", "output.directory"},
    {"m", "bodies.mass"},
    {"r", "particles.radius"},
    {"omega", "bodies.angular_velocity"},
    {"torque", "motors.effort"},
    {"torque", "applied_forces.torque_z"},
    {"kp", "motors.position_gain"},
    {"kd", "motors.rate_gain"},
    {"stroke", "cylinders.max_length"},
    {"actuators", "cylinders"},
    {"hydraulic_cylinders", "cylinders"},
    {"spin", "bodies.angular_velocity"},
});

}  // namespace scree
