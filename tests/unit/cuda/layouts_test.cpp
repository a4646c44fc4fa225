#include "support/catch.hpp"
#include "support/device_layouts.hpp"

namespace scree {

// nvcc 13 does not always count as the host does, and does not say so: see tests/style/checks.py.
TEST_CASE("records that the host and the kernels share have one size") {
  for (const Layout& layout : layouts_on_device()) {
    CAPTURE(layout.name);
    CHECK(layout.device == layout.host);
  }
}

}  // namespace scree
