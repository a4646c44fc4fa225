#include "dem/choose_law.hpp"
#include "dem/contact_kernels_impl.hpp"

namespace scree {

std::unique_ptr<ContactKernels> make_contact_kernels(const Contact& contact) {
  return with_contact_laws(contact,
                           [&]<class Law>(const std::vector<Law>& laws) -> std::unique_ptr<ContactKernels> {
                             if (laws.size() == 1)
                               return std::make_unique<CpuContactKernels<OneLaw<Law>>>(OneLaw<Law>{laws[0]});
                             return std::make_unique<CpuTableKernels<Law>>(laws, contact.materials());
                           });
}

}  // namespace scree
