#include "dem/laws/contact_kernels_impl.hpp"
#include "physics/cohesion.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

template std::unique_ptr<ContactKernels> cpu_kernels(
    const std::vector<ContactLaw<CohesiveLaw<LinearRestitutionLaw>, LinearSlider, AnyRolling>>&, int);

}  // namespace scree
