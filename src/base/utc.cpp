#include "base/utc.hpp"

#include <array>
#include <cmath>
#include <ctime>

namespace scree {

namespace {

constexpr const char* kFormat = "%Y-%m-%dT%H:%M:%SZ";

}  // namespace

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), kFormat, &parts);
  return text.data();
}

double seconds_since(const std::string& utc) {
  std::tm parts{};
  const char* const end = strptime(utc.c_str(), kFormat, &parts);
  if (end == nullptr || *end != '\0') return std::nan("");
  return std::difftime(std::time(nullptr), timegm(&parts));
}

}  // namespace scree
