// Trial positions of particles that are to be born, sorted into cells, and the search for particles that
// overlap them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Candidates in cells at least as wide as the distance of centres at which a candidate and a particle touch:
// partners are in neighbouring cells.
struct CandidateViews {
  Vec3 min;              // lower corner of the cells [m]
  Real edge = 0;         // [m]
  Index cells[3];        // per axis
  const Index* starts;   // first candidate of each cell, x fastest, and the number of all
  const Vec4* spheres;   // centre and radius [m]
  const Index* numbers;  // of each sphere, from 0; images across periodic sides have that of their original

  // Calls visit(number, sphere) for the candidates in the cells around p.
  template <class Visit>
  SCREE_HD void for_each_near(Vec3 p, const Visit& visit) const {
    const Index x = cell(p.x - min.x), y = cell(p.y - min.y), z = cell(p.z - min.z);
    if (x < -1 || x > cells[0] || y < -1 || y > cells[1] || z < -1 || z > cells[2]) return;
    const auto first = [](Index c) { return c > 0 ? c - 1 : 0; };
    const auto last = [](Index c, Index count) { return c < count - 1 ? c + 1 : count - 1; };
    for (Index k = first(z); k <= last(z, cells[2]); ++k)
      for (Index j = first(y); j <= last(y, cells[1]); ++j) {
        const Index row = (k * cells[1] + j) * cells[0];
        const Index end = starts[row + last(x, cells[0]) + 1];
        for (Index c = starts[row + first(x)]; c < end; ++c) visit(numbers[c], spheres[c]);
      }
  }

 private:
  // -2 for coordinates beyond the range of cell numbers.
  SCREE_HD Index cell(Real offset) const {
    const Real at = std::floor(offset / edge);
    return at >= -1 && at <= kMostCells ? static_cast<Index>(at) : -2;
  }
  static constexpr Real kMostCells = 1e6;  // per axis
};

// Marks the candidates that overlap a particle of this rank.
struct CandidateItem {
  CandidateViews candidates;
  const Vec4* position;  // of the particles; w: radius [m]
  const std::uint8_t* drifting;
  std::uint8_t* overlapped;  // per number; 1 where any particle overlaps it

  SCREE_HD void operator()(Index i) const {
    if (drifting[i] != 0) return;
    const Vec4 p = position[i];
    candidates.for_each_near(xyz(p), [&](Index number, const Vec4& sphere) {
      const Vec3 d = xyz(p) - xyz(sphere);
      const Real touch = p.w + sphere.w;
      if (dot(d, d) < touch * touch) overlapped[number] = 1;
    });
  }
};

class CandidateGrid {
 public:
  // spheres: centre in the periodic box and radius, at least one [m]; period: 0 along axes without one [m];
  // largest: radius of the particles [m].
  CandidateGrid(std::span<const Vec4> spheres, Vec3 period, Real largest);

  Index size() const { return size_; }  // number of spheres
  const std::vector<Index>& starts() const { return starts_; }
  const std::vector<Vec4>& spheres() const { return spheres_; }
  const std::vector<Index>& numbers() const { return numbers_; }
  // Views of the arrays, which may be copies of those above.
  CandidateViews views(const Index* starts, const Vec4* spheres, const Index* numbers) const;
  CandidateViews views() const { return views(starts_.data(), spheres_.data(), numbers_.data()); }

 private:
  Index size_;
  Vec3 min_;
  Real edge_;
  Index cells_[3] = {1, 1, 1};
  std::vector<Index> starts_, numbers_;
  std::vector<Vec4> spheres_;
};

}  // namespace scree
