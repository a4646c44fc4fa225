#include "dem/reports/triangle_works.hpp"

#include <algorithm>
#include <span>

#include "mesh/surface_mesh.hpp"

namespace scree {

TriangleWorks::TriangleWorks(const Model& model) : materials_(model.contact.materials()) {
  if (!model.output.adds_up_works()) return;
  const SurfaceSet surfaces(model);
  for (Index s = 0; s < surfaces.placed(); ++s) {
    const Surface& surface = surfaces.at(s);
    const bool is_mesh = surface.kind == SurfaceKind::mesh;
    first_.push_back(static_cast<std::int64_t>(triangles_));
    meshes_.push_back(is_mesh ? model.meshes[static_cast<std::size_t>(surface.mesh)].surface.get() : nullptr);
    if (is_mesh) triangles_ += meshes_.back()->triangles.size();
  }
  wear_ = model.contact.wear;
}

template <class Visit>
void TriangleWorks::for_each_row(const Visit& visit) const {
  for (std::size_t s = 0; s < meshes_.size(); ++s) {
    if (meshes_[s] == nullptr) continue;
    const auto first = static_cast<std::size_t>(first_[s]);
    for (std::size_t t = 0; t < meshes_[s]->triangles.size(); ++t)
      visit(first + static_cast<std::size_t>(meshes_[s]->original[t]), first + t);
  }
}

std::vector<std::int64_t> TriangleWorks::limbs(const std::vector<TriangleWork>& sums) const {
  std::vector<std::int64_t> limbs(kLimbsPerTriangle * triangles_);
  for_each_row([&](std::size_t row, std::size_t t) {
    auto to = limbs.begin() + static_cast<std::ptrdiff_t>(kLimbsPerTriangle * row);
    for (FixedSum sum : sums[t].of) {
      sum.normalize();
      to = std::ranges::copy(sum.word, to).out;
    }
  });
  return limbs;
}

std::vector<TriangleWork> TriangleWorks::sums(const std::vector<std::int64_t>& limbs) const {
  std::vector<TriangleWork> sums(triangles_);
  if (limbs.empty()) return sums;
  for_each_row([&](std::size_t row, std::size_t t) {
    auto from = limbs.begin() + static_cast<std::ptrdiff_t>(kLimbsPerTriangle * row);
    for (FixedSum& sum : sums[t].of) {
      std::ranges::copy_n(from, FixedSum::kNumbers, sum.word);
      from += FixedSum::kNumbers;
    }
  });
  return sums;
}

namespace {

FixedSum sum_at(const std::vector<std::int64_t>& limbs, std::size_t first) {
  FixedSum sum;
  std::copy_n(limbs.begin() + static_cast<std::ptrdiff_t>(first), FixedSum::kNumbers, sum.word);
  return sum;
}

// Normalizes limbs that were added one by one.
void normalize(std::vector<std::int64_t>& limbs) {
  for (std::size_t at = 0; at < limbs.size(); at += FixedSum::kNumbers) {
    FixedSum sum = sum_at(limbs, at);
    sum.normalize();
    std::ranges::copy(sum.word, limbs.begin() + static_cast<std::ptrdiff_t>(at));
  }
}

}  // namespace

std::vector<std::int64_t> all_works(std::vector<std::int64_t> limbs, const Ranks& ranks) {
  if (ranks.alone()) return limbs;
  ranks.sum(limbs);
  normalize(limbs);
  return limbs;
}

void add_works(const std::vector<std::int64_t>& more, std::vector<std::int64_t>& limbs) {
  for (std::size_t k = 0; k < more.size(); ++k) limbs[k] += more[k];
  normalize(limbs);
}

std::vector<TriangleWorkValues> work_values(const std::vector<std::int64_t>& limbs) {
  std::vector<TriangleWorkValues> values;
  for (std::size_t row = 0; row < limbs.size(); row += kLimbsPerTriangle) {
    FixedSum sum[kTriangleWorks];
    for (std::size_t k = 0; k < kTriangleWorks; ++k) sum[k] = sum_at(limbs, row + k * FixedSum::kNumbers);
    values.push_back(
        {sum[kImpactWork].value(), sum[kSlidingWork].value(), sum[kWornVolume].value() / kWornScale});
  }
  return values;
}

}  // namespace scree
