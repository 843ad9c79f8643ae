#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/hal.hpp>
#include <random>
#include <vector>

#include "vo/descriptor.hpp"

// Measures the search for the nearest of 2,000 binary descriptors of 64 bytes, and single
// distances. Compares them with OpenCV's, on one thread.

namespace roadbook {
namespace {

std::vector<Descriptor> random_descriptors(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Descriptor> all(count);
  for (Descriptor& d : all)
    for (std::uint8_t& byte : d) byte = static_cast<std::uint8_t>(random());
  return all;
}

cv::Mat as_matrix(std::vector<Descriptor>& all) {
  return {static_cast<int>(all.size()), 64, CV_8U, all.data()};
}

const auto kQueries = static_cast<std::size_t>(500);
const auto kStored = static_cast<std::size_t>(2000);

void count_pairs(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kQueries * kStored));
}

void nearest(benchmark::State& state) {
  const auto queries = random_descriptors(kQueries, 1);
  const auto stored = random_descriptors(kStored, 2);
  for (auto _ : state)
    for (const Descriptor& query : queries)
      benchmark::DoNotOptimize(nearest_descriptor(query, stored));
  count_pairs(state);
}
BENCHMARK(nearest)->Unit(benchmark::kMillisecond);

void single_distances(benchmark::State& state) {
  const auto queries = random_descriptors(kQueries, 1);
  const auto stored = random_descriptors(kStored, 2);
  for (auto _ : state)
    for (const Descriptor& query : queries)
      for (const Descriptor& one : stored) benchmark::DoNotOptimize(hamming(query, one));
  count_pairs(state);
}
BENCHMARK(single_distances)->Unit(benchmark::kMillisecond);

void nearest_by_opencv(benchmark::State& state) {
  cv::setNumThreads(1);
  auto queries = random_descriptors(kQueries, 1);
  auto stored = random_descriptors(kStored, 2);
  const cv::Mat query = as_matrix(queries);
  const cv::Mat all = as_matrix(stored);
  cv::Mat distance;
  cv::Mat index;
  for (auto _ : state) cv::batchDistance(query, all, distance, CV_32S, index, cv::NORM_HAMMING, 2);
  count_pairs(state);
}
BENCHMARK(nearest_by_opencv)->Unit(benchmark::kMillisecond);

void single_distances_by_opencv(benchmark::State& state) {
  const auto queries = random_descriptors(kQueries, 1);
  const auto stored = random_descriptors(kStored, 2);
  for (auto _ : state)
    for (const Descriptor& query : queries)
      for (const Descriptor& one : stored)
        benchmark::DoNotOptimize(cv::hal::normHamming(query.data(), one.data(), 64));
  count_pairs(state);
}
BENCHMARK(single_distances_by_opencv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbook
