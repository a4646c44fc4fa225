// Compiled for every x86-64 (CMakeLists.txt). The code must not use templates or inline functions of other
// headers, because the linker might choose the version that another file has compiled for newer processors.
#include "base/processor.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#endif
#include <sys/syscall.h>
#include <unistd.h>

namespace scree {
namespace {

#if defined(__x86_64__)

constexpr int kBadInput = 2;  // ExitCode::bad_input

// Register states that the operating system saves when it switches processes: bits of XCR0.
unsigned saved_state() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  constexpr unsigned kOsxsave = 1u << 27;
  if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) == 0 || (ecx & kOsxsave) == 0) return 0;
  asm volatile("xgetbv" : "=a"(eax), "=d"(edx) : "c"(0));
  return eax;
}

bool has(const ProcessorFeature& feature) {
  constexpr unsigned kSaved[] = {0, 0x6, 0xe6};
  const unsigned wanted = kSaved[feature.state];
  if (wanted != 0 && (saved_state() & wanted) != wanted) return false;
  unsigned found[4] = {};
  if (__get_cpuid_count(feature.leaf, feature.subleaf, &found[kEax], &found[kEbx], &found[kEcx],
                        &found[kEdx]) == 0)
    return false;
  return (found[feature.in] >> feature.bit & 1u) != 0;
}

void print(const char* text) {
  unsigned long length = 0;
  while (text[length] != 0) ++length;
  [[maybe_unused]] const auto written = write(2, text, length);
}

void print_number(unsigned number) {
  if (number >= 10) print_number(number / 10);
  const char digit[] = {static_cast<char>('0' + number % 10), 0};
  print(digit);
}

// Ends the program with a message that names the first missing instruction sets and counts the others.
[[noreturn]] void refuse(unsigned missing) {
  constexpr unsigned kNamed = 3;
  print("error: this program was built for a processor with ");
  unsigned named = 0;
  for (const ProcessorFeature* feature = kWantedFeatures; feature->name != nullptr; ++feature) {
    if (has(*feature)) continue;
    if (named > 0) print(named + 1 == missing ? " and " : ", ");
    print(feature->name);
    if (++named == kNamed) break;
  }
  if (missing > named) print(" and "), print_number(missing - named), print(" more");
  print(missing == 1 ? ", which this processor lacks" : ", all of which this processor lacks");
  print(
      ": it was configured with -march=native on another machine; configure it on this machine, or for every "
      "processor with -D SCREE_NATIVE=OFF\n");
  for (;;) syscall(SYS_exit_group, kBadInput);
}

// 101 is the first priority that is not reserved for the compiler.
__attribute__((constructor(101))) void check_processor() {
  unsigned missing = 0;
  for (const ProcessorFeature* feature = kWantedFeatures; feature->name != nullptr; ++feature)
    if (!has(*feature)) ++missing;
  if (missing > 0) refuse(missing);
}

#endif

}  // namespace

const ProcessorFeature* wanted_instructions() { return kWantedFeatures; }

}  // namespace scree
