// Mixtures of particles: components of different materials and size distributions, and the order in which
// their particles come.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "deck/choices.hpp"
#include "model/derived/distribution.hpp"

namespace scree {

struct MixtureComponent {
  int material = 0;
  Distribution radius;                    // [m]
  std::optional<Distribution> mass{};     // [kg]; without it density
  std::optional<Distribution> density{};  // [kg/m^3]
  Real thickness = 1;                     // of discs, for density [m]
  Real inertia_factor = 0;                // I / (m R^2)
  Real share = 1;                         // relative to the other components, > 0
};

struct MixtureOptions {
  std::uint64_t seed = 1;
  int dimension = 3;
  CountedBy counted_by = CountedBy::number;  // shares of the components
  MixtureShares shares = MixtureShares::exact;
};

// The particles of a mixture, numbered by n = 0, 1, 2, ... in the order of their births. A class is a
// component and a size bin of it: a part of its size distribution with a given probability by number, or one
// of the values of a table.
//
// shares = exact: after any n births the number of each component differs from its share by less than one
// particle, and that of each class of equal size bins too. Within a component, the number of each value of a
// table differs by less than one from its share of that component's births. The class of a birth depends on
// the seed and on the numbers of births of each class before it, which are part of the caller's state.
// shares = drawn: the class of birth n is random and depends on the seed and n alone.
// The particle of a birth depends on the seed, n and its class.
class Mixture {
 public:
  struct Birth {
    int size_class = 0;
    int component = 0;
  };
  struct Particle {
    Real radius = 0;  // [m]
    Real mass = 0;    // [kg]
    int material = 0;
    Real inertia_factor = 0;  // I / (m R^2)
  };

  Mixture(std::vector<MixtureComponent> components, const MixtureOptions& options);

  const std::vector<MixtureComponent>& components() const { return components_; }
  // Number of classes.
  int classes() const { return static_cast<int>(classes_.size()); }
  int component_of(int size_class) const { return classes_[static_cast<std::size_t>(size_class)].component; }
  // Share of a class or component by number; the sums are 1.
  Real share_of_class(int size_class) const;
  Real share_of_component(int component) const { return shares_[static_cast<std::size_t>(component)]; }

  // The class of birth n. counts: births of each class before it, whose sum is n; for drawn shares unused.
  // The caller then increments counts[size_class].
  Birth next(std::int64_t n, std::span<const std::int64_t> counts) const;
  // The particle of birth n.
  Particle particle(std::int64_t n, int size_class) const;

  Real mean_mass() const;    // by number [kg]
  Real mean_volume() const;  // by number, of solid particles [m^3]; 2D: area [m^2]
  Real smallest_radius() const;
  Real largest_radius() const;
  Real smallest_mass() const;
  Real largest_mass() const;
  // Of one component [kg].
  Real mean_mass_of(int component) const;
  Real smallest_mass_of(int component) const;
  Real largest_mass_of(int component) const;

 private:
  struct SizeClass {
    int component = 0;
    Real low = 0, high = 1;  // its part of the component's distribution, by number
  };
  const MixtureComponent& component(int k) const { return components_[static_cast<std::size_t>(k)]; }
  void add_classes(int component);
  Birth drawn(std::int64_t n) const;
  Real mass_of(const MixtureComponent& of, Real radius, Real density) const;

  std::vector<MixtureComponent> components_;
  MixtureOptions options_;
  std::vector<Real> shares_;        // of the components, by number
  std::vector<SizeClass> classes_;  // those of a component follow each other
  std::vector<std::size_t> first_;  // first class of each component, and the number of classes
  std::vector<Real> class_shares_;  // of each class within its component
};

}  // namespace scree
