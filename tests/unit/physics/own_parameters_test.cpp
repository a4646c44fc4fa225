// Parameters that one law alone has.
#include "physics/own_parameters.hpp"

#include "physics/eepa.hpp"
#include "physics/liquid_bridge.hpp"
#include "support/catch.hpp"

namespace scree {

TEST_CASE("parameters of a law's own answer for it; without any, the answers leave a law as it is") {
  const AnyParameters none, soil = Plasticity(0.6, 2);
  CHECK((!none && soil));
  CHECK((none->unloading_stiffness(3) == 3 && soil->unloading_stiffness(3) == 3 / (1 - 0.6)));
  CHECK((none->is_linear() && !soil->is_linear() && !none->attracts() && soil->attracts()));
  CHECK((none->explicit_only().empty() && !soil->explicit_only().empty()));
  CHECK((none->longest_step({1, 1, 1, 1}, 1) == kInfinity && none->interaction_range(1) == 0));
}

TEST_CASE("only a law that knows their type finds them") {
  const AnyParameters none, soil = Plasticity(0.6, 2);
  REQUIRE(soil.as<Plasticity>());
  CHECK((soil.as<Plasticity>()->ratio == 0.6 && soil.value<Plasticity>().adhesion_exponent == 2));
  CHECK((!soil.as<BridgeParameters>() && !soil.value<BridgeParameters>().liquid.acts()));
  CHECK((soil.are_only<Plasticity>() && !soil.are_only<BridgeParameters>() && none.are_only<Plasticity>()));
}

TEST_CASE("laws without parameters of their own refuse pairs with some") {
  NormalLawParameters law{.normal_stiffness = 1e4};
  CHECK((LinearLaw::accepts(law) && LinearRestitutionLaw::accepts(law) && PowerLaw::accepts(law)));
  law.own = Plasticity(0.6, 2);
  CHECK_FALSE((LinearLaw::accepts(law) || LinearRestitutionLaw::accepts(law) || PowerLaw::accepts(law)));
  CHECK_FALSE((CohesiveLaw<LinearRestitutionLaw>::accepts(law) || JkrLaw::accepts(law)));
  CHECK_FALSE(BridgeLaw<LinearRestitutionLaw>::accepts(law));
  CHECK(EepaLaw<LinearRestitutionLaw>::accepts(law));
  CHECK(law.numbers() != NormalLawParameters{.normal_stiffness = 1e4}.numbers());
}

}  // namespace scree
