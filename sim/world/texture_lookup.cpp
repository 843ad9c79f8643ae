#include "sim/world/texture_lookup.hpp"

#include <bit>
#include <cmath>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace roadbook {
namespace {

// Two levels are mixed in the middle two fifths between them.
constexpr float kMixSlope = 2.5F;
constexpr float kMixStart = 0.75F;

/// log2 to 0.01, enough to choose a level.
float fast_log2(float v) {
  const auto bits = std::bit_cast<std::uint32_t>(v);
  const float m = std::bit_cast<float>((bits & 0x007fffffU) | 0x3f800000U);
  return static_cast<float>(static_cast<int>(bits >> 23U) - 127) +
         ((-0.33582878F * m + 2.0F) * m - 1.65871022F);
}

/// Texel below a coordinate, and the share of the next one in 1/256.
struct Texel {
  int first;
  int share;
};

Texel locate(float u, int n, bool tiled) {
  if (!tiled) {
    u = u > 0.0F ? u : 0.0F;  // not a number, too
    const auto most = static_cast<float>(n - 1);
    u = u < most ? u : most;
  }
  const float below = std::floor(u);
  const int first = static_cast<int>(below);
  return {tiled ? first & (n - 1) : first, static_cast<int>((u - below) * 256.0F)};
}

float bilinear(const TexturePyramid& pyramid, int level, float x, float y) {
  const auto l = static_cast<std::size_t>(level);
  // Texel centres of level k lie at (2^k - 1) / 2 + i 2^k.
  const float scale = std::bit_cast<float>(static_cast<std::uint32_t>(127 - level) << 23U);
  const Texel u = locate((x + 0.5F) * scale - 0.5F, pyramid.width[l], pyramid.tiled);
  const Texel v = locate((y + 0.5F) * scale - 0.5F, pyramid.height[l], pyramid.tiled);
  const std::uint8_t* p = pyramid.texels.data() + pyramid.offset[l] +
                          static_cast<std::ptrdiff_t>(v.first) * pyramid.stride[l] + u.first;
  const std::uint8_t* q = p + pyramid.stride[l];
  // Shares of 8 bits: integers until the end.
  const int above = (p[0] << 8) + u.share * (p[1] - p[0]);
  const int under = (q[0] << 8) + u.share * (q[1] - q[0]);
  return static_cast<float>((above << 8) + v.share * (under - above)) * (1.0F / 65536.0F);
}

void look_up_one_by_one(const TexturePyramid& pyramid, Lookups& lookups) {
  for (std::size_t i = 0; i < lookups.count; ++i)
    lookups.value[i] = texture_at(pyramid, lookups.x[i], lookups.y[i], lookups.footprint[i]);
}

#if defined(__x86_64__)
// The functions above, eight at a time; no fused products, so that the bits are the same.
#define ROADBOOK_AVX2 __attribute__((target("avx2")))

struct Level8 {
  __m256i offset, stride, width, height;
  __m256 scale;
};

ROADBOOK_AVX2 inline Level8 level8(const TexturePyramid& pyramid, __m256i level) {
  Level8 l;
  l.scale =
      _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_sub_epi32(_mm256_set1_epi32(127), level), 23));
  const int first = _mm256_cvtsi256_si32(level);
  if (_mm256_movemask_epi8(_mm256_cmpeq_epi32(level, _mm256_set1_epi32(first))) == -1) {
    const auto i = static_cast<std::size_t>(first);  // nearly always: neighbours
    l.offset = _mm256_set1_epi32(pyramid.offset[i]);
    l.stride = _mm256_set1_epi32(pyramid.stride[i]);
    l.width = _mm256_set1_epi32(pyramid.width[i]);
    l.height = _mm256_set1_epi32(pyramid.height[i]);
  } else {
    l.offset = _mm256_i32gather_epi32(pyramid.offset.data(), level, 4);
    l.stride = _mm256_i32gather_epi32(pyramid.stride.data(), level, 4);
    l.width = _mm256_i32gather_epi32(pyramid.width.data(), level, 4);
    l.height = _mm256_i32gather_epi32(pyramid.height.data(), level, 4);
  }
  return l;
}

struct Texel8 {
  __m256i first, share;
};

ROADBOOK_AVX2 inline Texel8 locate8(__m256 u, __m256i n, bool tiled) {
  const __m256i most = _mm256_sub_epi32(n, _mm256_set1_epi32(1));
  if (!tiled) u = _mm256_min_ps(_mm256_max_ps(u, _mm256_setzero_ps()), _mm256_cvtepi32_ps(most));
  const __m256 below = _mm256_floor_ps(u);
  Texel8 t;
  t.first = _mm256_cvttps_epi32(below);
  if (tiled) t.first = _mm256_and_si256(t.first, most);
  t.share = _mm256_cvttps_epi32(_mm256_mul_ps(_mm256_sub_ps(u, below), _mm256_set1_ps(256.0F)));
  return t;
}

/// Mix of the two lowest bytes of every word, in 1/256.
ROADBOOK_AVX2 inline __m256i mix8(__m256i word, __m256i share) {
  const __m256i byte = _mm256_set1_epi32(255);
  const __m256i p0 = _mm256_and_si256(word, byte);
  const __m256i p1 = _mm256_and_si256(_mm256_srli_epi32(word, 8), byte);
  // Both factors fit in 16 bits and the upper half of the share is zero: the sum of the products of
  // pairs is the product, and cheaper than that of 32 bits.
  const __m256i product = _mm256_madd_epi16(share, _mm256_sub_epi32(p1, p0));
  return _mm256_add_epi32(_mm256_slli_epi32(p0, 8), product);
}

ROADBOOK_AVX2 inline __m256 bilinear8(const TexturePyramid& pyramid,
                                      __m256i level,
                                      __m256 x,
                                      __m256 y) {
  const Level8 l = level8(pyramid, level);
  const __m256 half = _mm256_set1_ps(0.5F);
  const auto coordinate = [&](__m256 at) ROADBOOK_AVX2 {
    return _mm256_sub_ps(_mm256_mul_ps(_mm256_add_ps(at, half), l.scale), half);
  };
  const Texel8 u = locate8(coordinate(x), l.width, pyramid.tiled);
  const Texel8 v = locate8(coordinate(y), l.height, pyramid.tiled);
  const __m256i at =
      _mm256_add_epi32(_mm256_add_epi32(l.offset, u.first), _mm256_mullo_epi32(v.first, l.stride));
  // Gathers take words at any byte; the pointer's type is only that of the intrinsic.
  const int* texels = static_cast<const int*>(static_cast<const void*>(pyramid.texels.data()));
  const __m256i above = mix8(_mm256_i32gather_epi32(texels, at, 1), u.share);
  const __m256i under =
      mix8(_mm256_i32gather_epi32(texels, _mm256_add_epi32(at, l.stride), 1), u.share);
  const __m256i sum = _mm256_add_epi32(_mm256_slli_epi32(above, 8),
                                       _mm256_mullo_epi32(v.share, _mm256_sub_epi32(under, above)));
  return _mm256_mul_ps(_mm256_cvtepi32_ps(sum), _mm256_set1_ps(1.0F / 65536.0F));
}

ROADBOOK_AVX2 inline __m256 log2_8(__m256 v) {
  const __m256i bits = _mm256_castps_si256(v);
  const __m256 m = _mm256_castsi256_ps(_mm256_or_si256(
      _mm256_and_si256(bits, _mm256_set1_epi32(0x007fffff)), _mm256_set1_epi32(0x3f800000)));
  const __m256 whole =
      _mm256_cvtepi32_ps(_mm256_sub_epi32(_mm256_srli_epi32(bits, 23), _mm256_set1_epi32(127)));
  const __m256 slope =
      _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(-0.33582878F), m), _mm256_set1_ps(2.0F));
  return _mm256_add_ps(whole, _mm256_sub_ps(_mm256_mul_ps(slope, m), _mm256_set1_ps(1.65871022F)));
}

ROADBOOK_AVX2 void look_up_eight_at_once(const TexturePyramid& pyramid, Lookups& lookups) {
  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256i last = _mm256_set1_epi32(pyramid.last);
  for (std::size_t i = lookups.count; i % 8 != 0; ++i) {
    lookups.x[i] = lookups.y[i] = 0.0F;
    lookups.footprint[i] = 1.0F;
  }
  for (std::size_t i = 0; i < lookups.count; i += 8) {
    const __m256 x = _mm256_load_ps(lookups.x.data() + i);
    const __m256 y = _mm256_load_ps(lookups.y.data() + i);
    const __m256 footprint = _mm256_max_ps(_mm256_load_ps(lookups.footprint.data() + i), one);
    const __m256 lod = _mm256_max_ps(log2_8(footprint), _mm256_setzero_ps());
    const __m256i level = _mm256_min_epi32(_mm256_cvttps_epi32(lod), last);
    const __m256 between = _mm256_sub_ps(lod, _mm256_cvtepi32_ps(level));
    __m256 f =
        _mm256_sub_ps(_mm256_mul_ps(_mm256_set1_ps(kMixSlope), between), _mm256_set1_ps(kMixStart));
    // Nothing is coarser than the last level.
    f = _mm256_andnot_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(level, last)), f);
    const __m256 coarser = _mm256_cmp_ps(f, one, _CMP_GE_OQ);
    const __m256i chosen = _mm256_sub_epi32(level, _mm256_castps_si256(coarser));
    __m256 value = bilinear8(pyramid, chosen, x, y);
    const __m256 mixed =
        _mm256_andnot_ps(coarser, _mm256_cmp_ps(f, _mm256_setzero_ps(), _CMP_GT_OQ));
    if (_mm256_movemask_ps(mixed) != 0) {
      const __m256i next = _mm256_min_epi32(_mm256_add_epi32(chosen, _mm256_set1_epi32(1)), last);
      const __m256 other = bilinear8(pyramid, next, x, y);
      const __m256 mix = _mm256_add_ps(value, _mm256_mul_ps(f, _mm256_sub_ps(other, value)));
      value = _mm256_blendv_ps(value, mix, mixed);
    }
    _mm256_store_ps(lookups.value.data() + i, value);
  }
}
#endif

}  // namespace

float texture_at(const TexturePyramid& pyramid, float x, float y, float footprint) {
  const float log = fast_log2(footprint > 1.0F ? footprint : 1.0F);
  const float lod = log > 0.0F ? log : 0.0F;
  const int level = static_cast<int>(lod) < pyramid.last ? static_cast<int>(lod) : pyramid.last;
  if (level == pyramid.last) return bilinear(pyramid, level, x, y);
  const float f = kMixSlope * (lod - static_cast<float>(level)) - kMixStart;
  if (f >= 1.0F) return bilinear(pyramid, level + 1, x, y);
  const float a = bilinear(pyramid, level, x, y);
  if (f <= 0.0F) return a;
  return a + f * (bilinear(pyramid, level + 1, x, y) - a);
}

TextureLookup choose_texture_lookup() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return look_up_eight_at_once;
#endif
  return look_up_one_by_one;
}

}  // namespace roadbook
