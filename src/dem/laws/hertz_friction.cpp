#include "dem/laws/contact_kernels_impl.hpp"
#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"

namespace scree {

template std::unique_ptr<ContactKernels> cpu_kernels(const std::vector<ContactLaw<HertzLaw, MindlinSlider>>&,
                                                     int);

}  // namespace scree
