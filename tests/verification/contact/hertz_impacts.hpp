// Impacts of a sphere on a rigid plane under the laws of Hertz and Mindlin: rows of the tables.
#pragma once

#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "verification/contact/plane_impacts.hpp"

namespace scree {

struct Material {
  Real young, poisson, density;  // [Pa], [-], [kg/m^3]

  explicit Material(const ReferenceTable::Row& row) : Material(row, row["rho"]) {}
  Material(const ReferenceTable::Row& row, Real rho) : young(row["E"]), poisson(row["nu"]), density(rho) {}
  // 4/3 E* and G* against a rigid partner [Pa].
  Real hertz_modulus() const { return Real(4) / 3 * young / (1 - poisson * poisson); }
  Real shear_modulus() const { return effective_shear_modulus(young, poisson, kInfinity, poisson); }
};

// Duration of an elastic impact: 2.94328 d_max / v, with 2/5 K d_max^(5/2) = m v^2 / 2 [s]; K [N/m^(3/2)].
inline Real hertz_time(Real stiffness, Real mass, Real speed) {
  return Real(2.94328) / speed * std::pow(Real(1.25) * mass * speed * speed / stiffness, Real(0.4));
}

// damping_ratio with the force clipped at zero.
struct HertzImpact : PlaneImpact {
  HertzLaw normal;
  MindlinSlider tangential;

  HertzImpact(const Material& material, Real radius, Vec3 velocity, Real damping_ratio)
      : PlaneImpact{{.velocity = velocity, .radius = radius, .mass = sphere_mass(radius, material.density)}},
        normal(material.hertz_modulus(), std::sqrt(Real(5)) * damping_ratio, false),
        tangential{material.shear_modulus(), 0, 0} {
    contact_time = hertz_time(normal.modulus * std::sqrt(radius), grain.mass, -velocity.z);
  }
  ContactLaw<HertzLaw, MindlinSlider> law() const { return {normal, tangential}; }
};

// oblique_mindlin.csv: 1 m/s without spin.
struct MindlinImpact : HertzImpact {
  explicit MindlinImpact(const ReferenceTable::Row& row)
      : HertzImpact(Material(row), row["R"], oblique(1, radians(row["angle_deg"])), row["z_cut"]) {
    tangential.friction = row["mu"];
    velocity_after = {row["vt"], 0, row["vn"]}, spin_after = {0, row["w"], 0};
  }
};

// chung_ooi_4.csv: one speed, all angles.
struct AngleImpact : HertzImpact {
  explicit AngleImpact(const ReferenceTable::Row& row)
      : HertzImpact(Material(row), row["R"], oblique(row["v"], radians(row["angle_deg"])),
                    damping_ratio_of(row["e"], false)) {
    tangential.friction = row["mu"];
    velocity_after = {row["e_t"] * grain.velocity.x, 0, -row["e"] * grain.velocity.z};
    spin_after = {0, row["w"], 0};
  }
};

// chung_ooi_5.csv: e = 1, one normal velocity; the plots' spin has the other sign.
struct RecoilImpact : HertzImpact {
  explicit RecoilImpact(const ReferenceTable::Row& row)
      : HertzImpact(Material(row), row["R"], {row["psi"] * row["mu"] * row["V"], 0, -row["V"]}, 0) {
    tangential.friction = row["mu"];
    const Real scale = row["mu"] * row["V"], turning = -row["spin"] * scale;  // R w
    velocity_after = {row["recoil"] * scale + turning, 0, row["V"]};
    spin_after = {0, turning / grain.radius, 0};
  }
};

// chung_ooi_6.csv: no tangential velocity, but a spin.
struct SpinImpact : HertzImpact {
  explicit SpinImpact(const ReferenceTable::Row& row)
      : HertzImpact(Material(row), row["R"], {0, 0, -row["V"]}, damping_ratio_of(row["e"], false)) {
    tangential.friction = row["mu"];
    grain.spin = {0, -row["w0"], 0};
    velocity_after = {row["vt"], 0, row["e"] * row["V"]}, spin_after = {0, row["w"], 0};
  }
};

}  // namespace scree
