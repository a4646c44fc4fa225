#include "base/mat3.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

std::array<Real, 3> principal_values(const Sym3& s) {
  Real a[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  constexpr int kSweeps = 30;  // five or six suffice
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const Real theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const Real t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const Real c = 1 / std::sqrt(t * t + 1), n = t * c;
        for (int k = 0; k < 3; ++k) {
          const Real x = a[k][p], y = a[k][q];
          a[k][p] = c * x - n * y, a[k][q] = n * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const Real x = a[p][k], y = a[q][k];
          a[p][k] = c * x - n * y, a[q][k] = n * x + c * y;
        }
        a[p][q] = a[q][p] = 0;
      }
    }
  }
  std::array<Real, 3> values{a[0][0], a[1][1], a[2][2]};
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace scree
