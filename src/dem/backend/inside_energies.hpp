// Energies of the particles inside the domain, from the sums of their item.
#pragma once

#include "dem/backend/reports.hpp"
#include "dem/reports/ledger_items.hpp"

namespace scree {

// sums: of InsideItem, indexed by InsideTerm. bodies: their contact losses are included, as in the ledger.
inline InsideEnergies make_inside_energies(const Real* sums, const HostSurfaces& bodies) {
  return {sums[kInsideKinetic], sums[kInsideGravitational],
          sums[kInsideIntegratorLoss] + bodies.losses().integrator_loss};
}

}  // namespace scree
