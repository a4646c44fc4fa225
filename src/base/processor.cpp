// Compiled for every x86-64 (CMakeLists.txt). Nothing here may use templates or inline functions of other
// headers: the linker might take what another file has made of them.
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

// What the operating system keeps of a process when another one has the processor: bits of XCR0.
unsigned kept_state() {
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  constexpr unsigned kOsxsave = 1u << 27;
  if (__get_cpuid(1, &eax, &ebx, &ecx, &edx) == 0 || (ecx & kOsxsave) == 0) return 0;
  asm volatile("xgetbv" : "=a"(eax), "=d"(edx) : "c"(0));
  return eax;
}

bool has(const ProcessorFeature& feature) {
  constexpr unsigned kKept[] = {0, 0x6, 0xe6};
  const unsigned wanted = kKept[feature.state];
  if (wanted != 0 && (kept_state() & wanted) != wanted) return false;
  unsigned found[4] = {};
  if (__get_cpuid_count(feature.leaf, feature.subleaf, &found[kEax], &found[kEbx], &found[kEcx],
                        &found[kEdx]) == 0)
    return false;
  return (found[feature.in] >> feature.bit & 1u) != 0;
}

void say(const char* text) {
  unsigned long length = 0;
  while (text[length] != 0) ++length;
  [[maybe_unused]] const auto written = write(2, text, length);
}

void say_number(unsigned number) {
  if (number >= 10) say_number(number / 10);
  const char digit[] = {static_cast<char>('0' + number % 10), 0};
  say(digit);
}

// The first of them by name, the others by their number.
[[noreturn]] void refuse(unsigned missing) {
  constexpr unsigned kNamed = 3;
  say("error: this program was built for a processor with ");
  unsigned named = 0;
  for (const ProcessorFeature* feature = kWantedFeatures; feature->name != nullptr; ++feature) {
    if (has(*feature)) continue;
    if (named > 0) say(named + 1 == missing ? " and " : ", ");
    say(feature->name);
    if (++named == kNamed) break;
  }
  if (missing > named) say(" and "), say_number(missing - named), say(" more");
  say(missing == 1 ? ", which this one has not" : ", none of which this one has");
  say(": it was configured with -march=native on another machine; configure it here, or with -D "
      "SCREE_NATIVE=OFF for every processor\n");
  for (;;) syscall(SYS_exit_group, kBadInput);
}

// 101 is the first of the priorities that are not the compiler's own.
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
