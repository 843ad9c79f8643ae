#include "mapping/localisation/descriptor_search.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/flann.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/error.hpp"

namespace roadbook {
namespace {

using Hamming = cvflann::Hamming<std::uint8_t>;

bool is_nearer(const NearDescriptor& a, const NearDescriptor& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
}

cv::Mat rows_of(const std::vector<Descriptor>& descriptors) {
  static_assert(sizeof(Descriptor) == 64);
  cv::Mat rows(static_cast<int>(descriptors.size()), 64, CV_8U);
  for (int i = 0; i < rows.rows; ++i)
    std::copy(descriptors[static_cast<std::size_t>(i)].begin(),
              descriptors[static_cast<std::size_t>(i)].end(), rows.ptr(i));
  return rows;
}

}  // namespace

void DescriptorSearchOptions::check() const {
  if (tables < 1 || tables > 64) throw InvalidOption("tables", std::to_string(tables), "1 to 64");
  if (key_bits < 4 || key_bits > 24)
    throw InvalidOption("key_bits", std::to_string(key_bits), "4 to 24");
  if (probe_level < 0 || probe_level > 2)
    throw InvalidOption("probe_level", std::to_string(probe_level), "0 to 2");
}

struct DescriptorSearch::Impl {
  std::vector<Descriptor> descriptors;
  cv::Mat rows;
  std::optional<cv::flann::GenericIndex<Hamming>> lsh;
};

DescriptorSearch::DescriptorSearch(std::vector<Descriptor> descriptors,
                                   const DescriptorSearchOptions& options)
    : impl_(std::make_unique<Impl>()) {
  options.check();
  impl_->descriptors = std::move(descriptors);
  if (options.method == DescriptorSearchMethod::kExact || impl_->descriptors.empty()) return;
  impl_->rows = rows_of(impl_->descriptors);
  // OpenCV's FLANN draws the bits of its keys from the generator of this thread.
  const cv::RNG before = cv::theRNG();
  cv::theRNG() = cv::RNG(options.seed);
  impl_->lsh.emplace(impl_->rows,
                     cvflann::LshIndexParams(static_cast<unsigned>(options.tables),
                                             static_cast<unsigned>(options.key_bits),
                                             static_cast<unsigned>(options.probe_level)));
  cv::theRNG() = before;
}

DescriptorSearch::~DescriptorSearch() = default;
DescriptorSearch::DescriptorSearch(DescriptorSearch&&) noexcept = default;
DescriptorSearch& DescriptorSearch::operator=(DescriptorSearch&&) noexcept = default;

std::vector<std::vector<NearDescriptor>> DescriptorSearch::nearest(
    const std::vector<Descriptor>& queries, std::size_t count, int max_distance) const {
  std::vector<std::vector<NearDescriptor>> found(queries.size());
  if (impl_->descriptors.empty() || queries.empty() || count == 0) return found;
  if (!impl_->lsh) {
    for (std::size_t q = 0; q < queries.size(); ++q) {
      std::vector<NearDescriptor>& near = found[q];
      for (std::size_t i = 0; i < impl_->descriptors.size(); ++i) {
        const NearDescriptor one{static_cast<int>(i), hamming(queries[q], impl_->descriptors[i])};
        if (one.distance > max_distance) continue;
        if (near.size() == count && !is_nearer(one, near.back())) continue;
        if (near.size() == count) near.pop_back();
        near.insert(std::upper_bound(near.begin(), near.end(), one, is_nearer), one);
      }
    }
    return found;
  }
  // Equal distances are ordered here: FLANN keeps those that it visits first.
  const int wanted = static_cast<int>(count);
  const cv::Mat rows = rows_of(queries);
  cv::Mat indices(rows.rows, wanted, CV_32S, cv::Scalar(-1));
  cv::Mat distances(rows.rows, wanted, CV_32S, cv::Scalar(0));
  impl_->lsh->knnSearch(rows, indices, distances, wanted, cvflann::SearchParams(-1, 0.0F, false));
  for (std::size_t q = 0; q < queries.size(); ++q) {
    const int row = static_cast<int>(q);
    for (int k = 0; k < wanted; ++k) {
      const int i = indices.at<int>(row, k);
      if (i < 0 || static_cast<std::size_t>(i) >= impl_->descriptors.size()) continue;
      const int distance = hamming(queries[q], impl_->descriptors[static_cast<std::size_t>(i)]);
      if (distance <= max_distance) found[q].push_back({i, distance});
    }
    std::sort(found[q].begin(), found[q].end(), is_nearer);
    found[q].erase(std::unique(found[q].begin(), found[q].end(),
                               [](const NearDescriptor& a, const NearDescriptor& b) {
                                 return a.index == b.index;
                               }),
                   found[q].end());
  }
  return found;
}

}  // namespace roadbook
