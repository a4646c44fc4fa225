#include "dem/laws/contact_kernels.hpp"

#include <numeric>

#include "model/derived/choose_law.hpp"

namespace scree {

std::unique_ptr<ContactKernels> make_contact_kernels(const Contact& contact) {
  return with_contact_laws(contact, [&](const auto& laws) { return cpu_kernels(laws, contact.materials()); });
}

std::vector<ContactLine> contact_lines(const ContactKernels& kernels, const ContactViews<PackedRows>& in,
                                       LineRequest to, std::vector<Index>& counts) {
  const auto n = static_cast<Index>(counts.size());
  std::vector<Index> offsets(counts.size() + 1);
  to.counts = counts.data();
  kernels.run(in, n, to);
  std::inclusive_scan(counts.begin(), counts.end(), offsets.begin() + 1);
  std::vector<ContactLine> lines(static_cast<std::size_t>(offsets.back()));
  to.lines = lines.data(), to.offsets = offsets.data();
  kernels.run(in, n, to);
  return lines;
}

}  // namespace scree
