#include "for_each.cuh"
#include "support/device_roots.hpp"

namespace scree {
namespace {

struct RootsItem {
  const Real* numbers;
  Roots* roots;
  __device__ void operator()(Index i) const { roots[i] = roots_of(numbers[i]); }
};

}  // namespace

std::vector<Roots> roots_on_device(const std::vector<Real>& numbers) {
  const Stream stream;
  DeviceArray<Real> from;
  from.upload(numbers, stream);
  DeviceArray<Roots> roots(numbers.size());
  for_each({stream}, static_cast<Index>(numbers.size()), RootsItem{from.data(), roots.data()});
  return roots.download(stream);
}

}  // namespace scree
