#include "dem/laws/contact_kernels_impl.hpp"
#include "physics/cohesion.hpp"

namespace scree {

template std::unique_ptr<ContactKernels> cpu_kernels(
    const std::vector<ContactLaw<CohesiveLaw<HertzLaw>, MindlinSlider, AnyRolling>>&, int);

}  // namespace scree
