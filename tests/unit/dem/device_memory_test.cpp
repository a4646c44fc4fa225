// Whether the ranks that share a GPU fit into its memory together.
#include "dem/device.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

constexpr std::size_t kMegabyte = 1000000;

DeviceClaim claim(char device, std::size_t needed, std::size_t free) {
  return {{device}, needed * kMegabyte, free * kMegabyte};
}

}  // namespace

TEST_CASE("a rank with a GPU of its own is judged by its own need") {
  const DeviceClaim claims[] = {claim('a', 300, 300), claim('b', 301, 300), claim('c', 1, 300)};
  CHECK(device_memory_trouble(claims, 0, "GPU") == "");
  CHECK(device_memory_trouble(claims, 1, "GPU") ==
        "the model needs about 301 MB of device memory, 300 MB are free on GPU");
  CHECK(device_memory_trouble(claims, 2, "GPU") == "");
}

TEST_CASE("the needs of ranks that share a GPU add up") {
  // Three ranks on a, two on b, in turn.
  const DeviceClaim claims[] = {claim('a', 200, 500), claim('b', 200, 500), claim('a', 150, 500),
                                claim('b', 300, 500), claim('a', 151, 500)};
  for (const int own : {0, 2, 4})
    CHECK(device_memory_trouble(claims, own, "GPU") ==
          "3 ranks share a GPU and together need about 501 MB of device memory, 500 MB are free on GPU");
  for (const int own : {1, 3}) CHECK(device_memory_trouble(claims, own, "GPU") == "");
}

TEST_CASE("the load of a GPU is that of all ranks that use it") {
  const DeviceClaim claims[] = {claim('a', 200, 500), claim('b', 100, 300), claim('a', 150, 400)};
  const DeviceLoad shared = load_of_device(claims, 2), single = load_of_device(claims, 1);
  CHECK((shared.ranks == 2 && shared.needed == 350 * kMegabyte && shared.free == 400 * kMegabyte));
  CHECK((single.ranks == 1 && single.needed == 100 * kMegabyte && single.free == 300 * kMegabyte));
}

TEST_CASE("ranks of a GPU agree on what is free: the least that one of them saw") {
  const DeviceClaim claims[] = {claim('a', 200, 450), claim('a', 200, 390)};
  for (const int own : {0, 1})
    CHECK(device_memory_trouble(claims, own, "GPU") ==
          "2 ranks share a GPU and together need about 400 MB of device memory, 390 MB are free on GPU");
}

}  // namespace scree
