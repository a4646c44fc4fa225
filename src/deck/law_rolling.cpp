// Resistance of a pair of materials to rolling and twisting.
#include "deck/pair_laws.hpp"

namespace scree {

namespace {

std::vector<Key> keys() {
  return {
      real("rolling_friction", "")
          .at_least(0)
          .left_out("no rolling resistance")
          .combined(Combining::mean)
          .about("mu_r: rolling resistance by a spring up to the moment mu_r R* F (Ai, Chen, Rotter, Ooi, "
                 "2011, model C), R*: reduced radius. mu_r is the tangent of the slope on which a sphere "
                 "begins to roll. Needs friction; 0: none."),
      real("rolling_stiffness", "N m")
          .above(0)
          .left_out("2.25 K mu_r^2 R*^2, in 2D 3 K mu_r^2 R*^2, K: dF/dd")
          .combined(Combining::series)
          .about("Stiffness of the rolling spring."),
      real("rolling_damping_ratio", "")
          .at_least(0)
          .otherwise("0.0")
          .combined(Combining::mean)
          .about("Damping ratio of the dashpot in parallel with the rolling spring, within the same limit, "
                 "relative to critical damping."),
      real("rolling_damping", "N m s")
          .at_least(0)
          .left_out("none")
          .combined(Combining::mean)
          .about("Coefficient C of a viscous rolling moment C w, w: rolling rate; with the rolling spring "
                 "or without. It holds nothing at rest. Needs friction."),
      real("twisting_friction", "")
          .at_least(0)
          .left_out("friction, where there is rolling resistance in 3D; otherwise no twisting resistance")
          .combined(Combining::other)
          .about("mu of the spring that resists twisting (relative rotation about the normal); it slides at "
                 "the moment 2/3 a mu F, a: contact radius sqrt(R* d) (Marshall, 2009).")};
}

// Default stiffness: 2.25 K mu_r^2 R*^2 in space and 3 K mu_r^2 R*^2 in the plane (ElasticPlasticRolling).
void take(const PairInDeck& pair, PairParameters& parameters) {
  const DeckTable& table = pair.table;
  const bool springs = is_positive(table, "rolling_friction"),
             acts = springs || is_positive(table, "rolling_damping");
  for (const char* key : {"rolling_friction", "rolling_damping", "twisting_friction"})
    if (is_positive(table, key) && !table.has("friction")) table.fail(key, "needs friction; it may be 0");
  if (table.has("rolling_stiffness") && !table.has("rolling_friction"))
    table.fail("rolling_stiffness", "needs rolling_friction");
  if (table.real("rolling_damping_ratio") > 0 && !table.has("rolling_friction"))
    table.fail("rolling_damping_ratio", "needs rolling_friction");
  if (pair.dimension == 2 && is_positive(table, "twisting_friction"))
    table.fail("twisting_friction", "must be left out in 2D: discs do not twist");
  RollingParameters& rolling = parameters.rolling;
  if (springs) {
    rolling.friction = table.real("rolling_friction");
    if (table.has("rolling_stiffness"))
      rolling.stiffness = table.real("rolling_stiffness");
    else
      rolling.stiffness_factor = pair.dimension == 2 ? 3 : Real(2.25);
    rolling.damping_ratio = table.real("rolling_damping_ratio");
  }
  if (table.has("rolling_damping")) rolling.damping = table.real("rolling_damping");
  if (table.has("twisting_friction"))
    rolling.twisting_friction = table.real("twisting_friction");
  else if (acts && pair.dimension == 3)
    rolling.twisting_friction = parameters.friction.friction;
}

}  // namespace

PairLaw pair_law_list::rolling() { return {keys, take}; }

}  // namespace scree
