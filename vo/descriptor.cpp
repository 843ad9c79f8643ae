#include "vo/descriptor.hpp"

#include <bit>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace roadbook {
namespace {

void consider(NearestDescriptor& best, int distance, std::size_t i) {
  if (distance < best.distance) {
    best.second = best.distance;
    best.distance = distance;
    best.index = static_cast<int>(i);
  } else if (distance < best.second) {
    best.second = distance;
  }
}

[[gnu::always_inline]] inline int distance_of(const std::uint8_t* a, const std::uint8_t* b) {
  int distance = 0;
  for (std::size_t i = 0; i < 64; i += 8) {
    std::uint64_t x = 0;
    std::uint64_t y = 0;
    std::memcpy(&x, a + i, 8);
    std::memcpy(&y, b + i, 8);
    distance += std::popcount(x ^ y);
  }
  return distance;
}

// Baseline x86-64 has no popcnt instruction: the generic count goes through a table.
__attribute__((target_clones("popcnt", "default"))) int hamming_by_words(const Descriptor& a,
                                                                         const Descriptor& b) {
  return distance_of(a.data(), b.data());
}

__attribute__((target_clones("popcnt", "default"))) NearestDescriptor nearest_by_words(
    const Descriptor& query, std::span<const Descriptor> descriptors) {
  NearestDescriptor best;
  for (std::size_t i = 0; i < descriptors.size(); ++i)
    consider(best, distance_of(query.data(), descriptors[i].data()), i);
  return best;
}

#if defined(__x86_64__)

#define ROADBOOK_AVX2 __attribute__((target("avx2"))) inline

ROADBOOK_AVX2 __m256i half_of(const Descriptor& d, int half) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(d.data() + 32 * half));
}

// Bits of each byte, from a table of the counts of its two halves (Mula 2008), added up in each
// lane of 64 bits.
ROADBOOK_AVX2 __m256i bits_in_lanes(__m256i low_half, __m256i high_half) {
  const __m256i table = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                         0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m256i nibble = _mm256_set1_epi8(0x0f);
  __m256i bits = _mm256_setzero_si256();
  for (const __m256i bytes : {low_half, high_half}) {
    const __m256i low = _mm256_and_si256(bytes, nibble);
    const __m256i high = _mm256_and_si256(_mm256_srli_epi16(bytes, 4), nibble);
    bits = _mm256_add_epi8(bits, _mm256_shuffle_epi8(table, low));
    bits = _mm256_add_epi8(bits, _mm256_shuffle_epi8(table, high));
  }
  return _mm256_sad_epu8(bits, _mm256_setzero_si256());
}

ROADBOOK_AVX2 __m256i difference_in_lanes(__m256i low, __m256i high, const Descriptor& other) {
  return bits_in_lanes(_mm256_xor_si256(low, half_of(other, 0)),
                       _mm256_xor_si256(high, half_of(other, 1)));
}

ROADBOOK_AVX2 int sum_of_lanes(__m256i lanes) {
  const __m128i two =
      _mm_add_epi64(_mm256_castsi256_si128(lanes), _mm256_extracti128_si256(lanes, 1));
  return static_cast<int>(_mm_cvtsi128_si64(two) + _mm_extract_epi64(two, 1));
}

ROADBOOK_AVX2 int hamming_by_table(const Descriptor& a, const Descriptor& b) {
  return sum_of_lanes(difference_in_lanes(half_of(a, 0), half_of(a, 1), b));
}

ROADBOOK_AVX2 NearestDescriptor nearest_by_table(const Descriptor& query,
                                                 std::span<const Descriptor> descriptors) {
  const __m256i low = half_of(query, 0);
  const __m256i high = half_of(query, 1);
  NearestDescriptor best;
  std::size_t i = 0;
  // Four at a time: their lanes are added up together.
  for (; i + 4 <= descriptors.size(); i += 4) {
    const __m256i d0 = difference_in_lanes(low, high, descriptors[i]);
    const __m256i d1 = difference_in_lanes(low, high, descriptors[i + 1]);
    const __m256i d2 = difference_in_lanes(low, high, descriptors[i + 2]);
    const __m256i d3 = difference_in_lanes(low, high, descriptors[i + 3]);
    // Each lane of 64 bits holds a number below 2^32: two fit into one.
    const __m256i d01 = _mm256_or_si256(d0, _mm256_slli_epi64(d1, 32));
    const __m256i d23 = _mm256_or_si256(d2, _mm256_slli_epi64(d3, 32));
    const __m256i pairs =
        _mm256_add_epi32(_mm256_unpacklo_epi64(d01, d23), _mm256_unpackhi_epi64(d01, d23));
    const __m128i sums =
        _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
    // No one of the four changes anything where all are at least the second nearest.
    const __m128i second = _mm_set1_epi32(best.second);
    if (_mm_movemask_epi8(_mm_cmplt_epi32(sums, second)) == 0) continue;
    alignas(16) std::int32_t distance[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(distance), sums);
    for (std::size_t k = 0; k < 4; ++k) consider(best, distance[k], i + k);
  }
  for (; i < descriptors.size(); ++i)
    consider(best, sum_of_lanes(difference_in_lanes(low, high, descriptors[i])), i);
  return best;
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

#endif

}  // namespace

int hamming(const Descriptor& a, const Descriptor& b) {
#if defined(__x86_64__)
  if (kHasAvx2) return hamming_by_table(a, b);
#endif
  return hamming_by_words(a, b);
}

NearestDescriptor nearest_descriptor(const Descriptor& query,
                                     std::span<const Descriptor> descriptors) {
#if defined(__x86_64__)
  if (kHasAvx2) return nearest_by_table(query, descriptors);
#endif
  return nearest_by_words(query, descriptors);
}

}  // namespace roadbook
