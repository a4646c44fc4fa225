// Instruction sets of the build according to the compiler's macros: this file is compiled like the rest of
// the program, but contains no code. It lists the sets that compilers use on their own. Sets that only
// explicit calls use (AES, SHA, RDSEED, CLZERO) are left out, because the program runs without them.
#include "base/processor.hpp"

namespace scree {

constinit const ProcessorFeature kWantedFeatures[] = {
#if defined(__x86_64__)
#ifdef __AVX512F__
    {"AVX-512F", 7, 0, kEbx, 16, kZmm},
#endif
#ifdef __AVX2__
    {"AVX2", 7, 0, kEbx, 5, kYmm},
#endif
#ifdef __FMA__
    {"FMA", 1, 0, kEcx, 12, kYmm},
#endif
#ifdef __AVX__
    {"AVX", 1, 0, kEcx, 28, kYmm},
#endif
#ifdef __AVX512DQ__
    {"AVX-512DQ", 7, 0, kEbx, 17, kZmm},
#endif
#ifdef __AVX512BW__
    {"AVX-512BW", 7, 0, kEbx, 30, kZmm},
#endif
#ifdef __AVX512VL__
    {"AVX-512VL", 7, 0, kEbx, 31, kZmm},
#endif
#ifdef __AVX512CD__
    {"AVX-512CD", 7, 0, kEbx, 28, kZmm},
#endif
#ifdef __AVX512ER__
    {"AVX-512ER", 7, 0, kEbx, 27, kZmm},
#endif
#ifdef __AVX512PF__
    {"AVX-512PF", 7, 0, kEbx, 26, kZmm},
#endif
#ifdef __AVX512IFMA__
    {"AVX-512IFMA", 7, 0, kEbx, 21, kZmm},
#endif
#ifdef __AVX512VBMI__
    {"AVX-512VBMI", 7, 0, kEcx, 1, kZmm},
#endif
#ifdef __AVX512VBMI2__
    {"AVX-512VBMI2", 7, 0, kEcx, 6, kZmm},
#endif
#ifdef __AVX512VNNI__
    {"AVX-512VNNI", 7, 0, kEcx, 11, kZmm},
#endif
#ifdef __AVX512BITALG__
    {"AVX-512BITALG", 7, 0, kEcx, 12, kZmm},
#endif
#ifdef __AVX512VPOPCNTDQ__
    {"AVX-512VPOPCNTDQ", 7, 0, kEcx, 14, kZmm},
#endif
#ifdef __AVX5124VNNIW__
    {"AVX-5124VNNIW", 7, 0, kEdx, 2, kZmm},
#endif
#ifdef __AVX5124FMAPS__
    {"AVX-5124FMAPS", 7, 0, kEdx, 3, kZmm},
#endif
#ifdef __AVX512VP2INTERSECT__
    {"AVX-512VP2INTERSECT", 7, 0, kEdx, 8, kZmm},
#endif
#ifdef __AVX512FP16__
    {"AVX-512FP16", 7, 0, kEdx, 23, kZmm},
#endif
#ifdef __AVX512BF16__
    {"AVX-512BF16", 7, 1, kEax, 5, kZmm},
#endif
#ifdef __AVXVNNI__
    {"AVX-VNNI", 7, 1, kEax, 4, kYmm},
#endif
#ifdef __AVXIFMA__
    {"AVX-IFMA", 7, 1, kEax, 23, kYmm},
#endif
#ifdef __AVXVNNIINT8__
    {"AVX-VNNI-INT8", 7, 1, kEdx, 4, kYmm},
#endif
#ifdef __AVXNECONVERT__
    {"AVX-NE-CONVERT", 7, 1, kEdx, 5, kYmm},
#endif
#ifdef __F16C__
    {"F16C", 1, 0, kEcx, 29, kYmm},
#endif
#ifdef __FMA4__
    {"FMA4", 0x80000001, 0, kEcx, 16, kYmm},
#endif
#ifdef __XOP__
    {"XOP", 0x80000001, 0, kEcx, 11, kYmm},
#endif
#ifdef __GFNI__
    {"GFNI", 7, 0, kEcx, 8, kAlways},
#endif
#ifdef __BMI2__
    {"BMI2", 7, 0, kEbx, 8, kAlways},
#endif
#ifdef __BMI__
    {"BMI1", 7, 0, kEbx, 3, kAlways},
#endif
#ifdef __TBM__
    {"TBM", 0x80000001, 0, kEcx, 21, kAlways},
#endif
#ifdef __LZCNT__
    {"LZCNT", 0x80000001, 0, kEcx, 5, kAlways},
#endif
#ifdef __MOVBE__
    {"MOVBE", 1, 0, kEcx, 22, kAlways},
#endif
#ifdef __ADX__
    {"ADX", 7, 0, kEbx, 19, kAlways},
#endif
#ifdef __POPCNT__
    {"POPCNT", 1, 0, kEcx, 23, kAlways},
#endif
#ifdef __SSE4_2__
    {"SSE4.2", 1, 0, kEcx, 20, kAlways},
#endif
#ifdef __SSE4_1__
    {"SSE4.1", 1, 0, kEcx, 19, kAlways},
#endif
#ifdef __SSSE3__
    {"SSSE3", 1, 0, kEcx, 9, kAlways},
#endif
#ifdef __SSE3__
    {"SSE3", 1, 0, kEcx, 0, kAlways},
#endif
#if defined(__LAHF_SAHF__)
    {"LAHF", 0x80000001, 0, kEcx, 0, kAlways},
#endif
#if defined(__GCC_HAVE_SYNC_COMPARE_AND_SWAP_16)
    {"CX16", 1, 0, kEcx, 13, kAlways},
#endif
#endif
    {nullptr, 0, 0, kEax, 0, kAlways}};

}  // namespace scree
