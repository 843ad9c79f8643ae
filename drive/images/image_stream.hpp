#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "drive/drive_options.hpp"
#include "drive/images/grey_range.hpp"
#include "drive/problem_list.hpp"
#include "drive/stamps.hpp"
#include "drive/stream_summary.hpp"

namespace roadbook {

/// File names of a stream's images by stamp. Nearly all streams name them by one rule, the stamp
/// padded with zeros and an extension; only names that break it are stored.
class ImageNames {
 public:
  void add(std::int64_t t_ns, const std::string& name);
  [[nodiscard]] std::string at(std::int64_t t_ns) const;
  /// From here on `at` takes stamps that are so much later than those of the names.
  void shift(std::int64_t by_ns) { shift_ns_ += by_ns; }

 private:
  [[nodiscard]] std::string by_rule(std::int64_t t_ns) const;
  bool has_rule_ = false;
  std::size_t digits_ = 0;
  std::string extension_;
  std::unordered_map<std::int64_t, std::string> others_;
  std::int64_t shift_ns_ = 0;
};

/// Size every image of a stream must have; zeros: not known.
struct ImageSize {
  int width = 0;
  int height = 0;
};

/// Images of one stream that follow each other and hold the same bytes.
struct RepeatedImages {
  std::size_t count = 0;  ///< the first one included
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::int64_t first_line = 0;  ///< of data.csv
};

/// One camera's (or segmentation's) images.
struct ImageStream {
  std::filesystem::path folder;  ///< that holds the files
  ImageNames names;
  std::vector<std::int64_t> stamps_ns;  ///< of the images that are there and whole, ascending
  StreamSummary summary;
  std::string digest;                   ///< of stamps, names and file sizes
  std::vector<RepeatedImages> repeats;  ///< of five images and more
  std::optional<GreyRange> greys;       ///< of its 16-bit images; empty: it has none

  std::int64_t shifted_ns = 0;  ///< what `shift` has added to the stamps of the table

  /// Moves the stamps of the images; the summary keeps those of the table.
  void shift(std::int64_t by_ns);
};

/// Reads `sensor_folder`/data.csv and looks at the head and tail of every image file. A table fault
/// or an image of another size is an error; a missing or damaged file is a warning, unless no image
/// of the stream is left.
[[nodiscard]] ImageStream load_image_stream(const std::filesystem::path& sensor_folder,
                                            const ImageSize& size,
                                            const StampLimits& limits,
                                            const DriveOptions& options,
                                            ProblemList& problems);

/// Warns if the camera's 16-bit images use a part of their bits, and says how they are read.
void warn_of_grey_range(const ImageStream& stream, ProblemList& problems);

/// Decodes one file to grey 8 bit; `greys` of a 16-bit image become 0 to 255. On failure empty, and
/// `why` describes the fault. Checks the size before decoding; safe to call concurrently.
[[nodiscard]] cv::Mat decode_image_file(const std::filesystem::path& file,
                                        const ImageSize& size,
                                        std::string& why,
                                        const GreyRange& greys = {});

}  // namespace roadbook
