#if SCREE_REFACTORS
// Reused pivots with matrices of redundant constraints, some of whose pivots are a billionth of the others.
#include "mbs/hht_method.hpp"
#include "mbs/klu_factors.hpp"
#include "mbs/rigid_body_system.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/loops.hpp"

using namespace scree;

TEST_CASE("factors of a loop that passes its flat position are those of factoring anew") {
  // The larger one is ordered by COLAMD.
  const int loops = GENERATE(2, 6);
  const Model model = bars(loops, false);
  MultibodyRun run(model, 1e-8);
  RigidBodySystem system(model);
  HhtMethod method(system, model.integrator.hht_alpha, run.state.position, run.state.velocity,
                   system.inverse_mass());
  std::vector<Real> values(method.pattern().column.size());
  KluFactors reused;
  REQUIRE(reused.analyze(method.pattern()));
  int refactored = 0;
  for (int i = 0; i < 1300; ++i) {
    method.predict(run.state, run.time, 1e-3);
    method.evaluate_residual();
    method.newton_matrix(values);
    refactored += reused.factor(values) == KluFactors::Result::refactored;
    KluFactors fresh;
    REQUIRE(fresh.analyze(method.pattern()));
    REQUIRE(fresh.factor(values) == KluFactors::Result::factored);
    std::vector<Real> one = method.residual(), other = one;
    REQUIRE(reused.solve(one));
    REQUIRE(fresh.solve(other));
    REQUIRE(same_bits(one, other));
    run.step(1e-3);
  }
  CAPTURE(loops, refactored);
  CHECK(refactored > 650);  // of 1300
}
#endif
