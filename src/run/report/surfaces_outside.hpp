// Surfaces that extend beyond open sides of the domain. Particles that leave there are excluded from contact
// detection, so that the load of a bucket falls through it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dem/reports/escape_items.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

// The warning on bodies whose shapes and meshes extend beyond an open side at t = 0, and on triangle walls
// that do so during the run, tested at about a hundred instants if they move. Empty if there are none,
// without particles, and if a particle that leaves is an error.
std::string outside_at_start(const Model& model);

// Finds particles that leave the domain at surfaces that could hold them.
class SurfacesOutside {
 public:
  explicit SurfacesOutside(const Model& model);
  // The warning on the first escaped particle at the surfaces of a body or wall that extends beyond an open
  // side: inside the surfaces' bounding box or less than a particle's diameter from it. Empty if there is
  // none. motion: of the bodies, then of the placed walls, at time t [s].
  std::string warning(std::span<const EscapedParticle> escaped_particles, std::span<const BodyMotion> motion,
                      Real t) const;

 private:
  const Model& model_;
  std::vector<std::optional<Box>> boxes_;  // per parent, in its own frame; none for planes
  std::vector<std::string> names_;
};

}  // namespace scree
