#include "dem/search/candidate_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"
#include "model/derived/posed_meshes.hpp"

namespace scree {
namespace {

// Limits of the number of cells; where more would be needed, they become wider.
constexpr Real kCellsPerSphere = 8, kLeastCells = 4096;

constexpr Real Vec3::*kAxes[3] = {&Vec3::x, &Vec3::y, &Vec3::z};

}  // namespace

CandidateGrid::CandidateGrid(std::span<const Vec4> spheres, Vec3 period, Real largest)
    : size_(as_index(spheres.size())) {
  Real radius = 0;
  for (const Vec4& s : spheres) radius = std::max(radius, s.w);
  edge_ = radius + largest;
  Vec3 low = xyz(spheres.front()), high = low;
  const auto widen = [&](Vec3 p) {
    for (Real Vec3::*axis : kAxes)
      low.*axis = std::min(low.*axis, p.*axis), high.*axis = std::max(high.*axis, p.*axis);
  };
  std::vector<Vec4> images;
  std::vector<Index> numbers;
  const std::vector<Vec3> shifts = image_shifts(period);
  for (Index n = 0; n < size_; ++n)
    for (const Vec3 shift : shifts) {
      const Vec4& s = spheres[as_size(n)];
      images.push_back(vec4(xyz(s) + shift, s.w)), numbers.push_back(n);
      widen(xyz(s) + shift);
    }
  min_ = low;
  const Vec3 extent = high - low;
  const auto count = [&] {
    Real all = 1;
    for (Real Vec3::*axis : kAxes) all *= std::floor(extent.*axis / edge_) + 1;
    return all;
  };
  while (count() > std::max(kLeastCells, kCellsPerSphere * static_cast<Real>(images.size()))) edge_ *= 2;
  for (int axis = 0; axis < 3; ++axis)
    cells_[axis] = static_cast<Index>(std::floor(extent.*kAxes[axis] / edge_)) + 1;
  const auto cell_of = [&](const Vec4& s) {
    Index c[3];
    for (int axis = 0; axis < 3; ++axis)
      c[axis] = static_cast<Index>(std::floor((xyz(s).*kAxes[axis] - min_.*kAxes[axis]) / edge_));
    return as_size((c[2] * cells_[1] + c[1]) * cells_[0] + c[0]);
  };
  starts_.assign(as_size(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  for (const Vec4& s : images) ++starts_[cell_of(s) + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  spheres_.resize(images.size()), numbers_.resize(images.size());
  std::vector<Index> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t k = 0; k < images.size(); ++k) {
    const auto at = as_size(next[cell_of(images[k])]++);
    spheres_[at] = images[k], numbers_[at] = numbers[k];
  }
}

CandidateViews CandidateGrid::views(const Index* starts, const Vec4* spheres, const Index* numbers) const {
  return {min_, edge_, {cells_[0], cells_[1], cells_[2]}, starts, spheres, numbers};
}

}  // namespace scree
