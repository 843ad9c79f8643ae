#include "drive/images/image_stream.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "base/digest.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/text_file.hpp"
#include "drive/csv.hpp"
#include "drive/images/image_files.hpp"
#include "drive/images/image_header.hpp"
#include "drive/images/jpeg_grey.hpp"
#include "drive/images/png_grey.hpp"
#include "drive/plausible.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

struct ImageRow {
  std::int64_t t_ns = 0;
  std::int64_t line = 0;
};

bool is_plain_name(std::string_view name) {
  constexpr std::size_t kLongest = 255;
  return !name.empty() && name.size() <= kLongest && name != "." && name != ".." &&
         std::none_of(name.begin(), name.end(),
                      [](char c) { return c == '/' || c == '\\' || (c >= 0 && c < ' '); });
}

std::vector<ImageRow> read_rows(const std::filesystem::path& file,
                                const StampLimits& limits,
                                ImageStream& stream,
                                ProblemList& problems) {
  std::vector<ImageRow> rows;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  StampCheck stamps(file.string(), problems);
  if (csv.good()) {
    const auto t_column = csv.require("timestamp", "ns|");
    const auto name_column = csv.require("filename", "|-");
    while (csv.next()) {
      const auto t = csv.stamp(*t_column);
      const std::string_view name = csv.fields()[*name_column];
      if (!is_plain_name(name))
        problems.error(csv.file(), csv.line(), "filename", printable(name), "a plain file name");
      if (!t || !is_plain_name(name) || !stamps.add(*t, csv.line())) continue;
      rows.push_back({*t, csv.line()});
      stream.names.add(*t, std::string(name));
    }
  }
  stream.summary = stamps.finish(stream.folder.parent_path().filename().string(), limits);
  if (csv.good() && rows.empty()) problems.error(file.string(), 0, "", "no rows", "at least one");
  return rows;
}

std::string size_text(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

bool too_large(const ImageHeader& header, double max_megapixels) {
  return static_cast<double>(header.width) * static_cast<double>(header.height) >
         max_megapixels * 1e6;
}

// Whether the image can be used; its faults go to `problems`.
bool accept(const ImageHeader& header,
            const ImageRow& row,
            const std::string& table,
            const std::string& name,
            double max_megapixels,
            ProblemList& problems) {
  if (too_large(header, max_megapixels)) {
    problems.error(table, row.line, name, size_text(header.width, header.height) + " pixels",
                   "at most " + std::to_string(std::int64_t(max_megapixels)) + " megapixels");
    return false;
  }
  if (header.state == ImageState::kGood) return true;
  problems.warning(table, row.line, name, to_text(header.state), "an image");
  return false;
}

// Images of other sizes than sensor.yaml states: one error a size, for all of them have one cause.
class OtherSizes {
 public:
  explicit OtherSizes(const ImageSize& want) : want_(want) {}
  // Whether the image has another size.
  bool add(const ImageHeader& header, const ImageRow& row, const std::string& name) {
    const bool known = header.width > 0 && header.height > 0 && want_.width > 0;
    if (!known || (header.width == want_.width && header.height == want_.height)) return false;
    auto& [first, first_name, count] = found_[{header.width, header.height}];
    if (count++ == 0) {
      first = row;
      first_name = name;
    }
    return true;
  }
  void report(const std::string& table, ProblemList& problems) const {
    for (const auto& [size, images] : found_) {
      const auto& [width, height] = size;
      std::string got = size_text(width, height) + " pixels" +
                        in_brackets(size_cause(width, height, want_.width, want_.height));
      if (images.count > 1) got += ", as " + std::to_string(images.count - 1) + " more images have";
      problems.error(table, images.first.line, images.name, got,
                     size_text(want_.width, want_.height) + " as sensor.yaml states");
    }
  }

 private:
  struct Images {
    ImageRow first;
    std::string name;
    std::size_t count = 0;
  };
  ImageSize want_;
  std::map<std::pair<std::int64_t, std::int64_t>, Images> found_;
};

// Single images are listed; how many there are of all says whether the drive is worth using.
void warn_of_share(const ImageStream& stream, std::size_t rows, ProblemList& problems) {
  const std::size_t good = stream.stamps_ns.size();
  if (good == 0 || 10 * (rows - good) <= rows) return;
  problems.warning(stream.folder.string(), 0, "images",
                   std::to_string(good) + " of " + std::to_string(rows) + " (" +
                       std::to_string(100 * good / rows) + " %) usable",
                   "nearly all that data.csv names");
}

// Images of the folder that no row names are not used: more images than stamps.
void warn_of_unnamed_images(const ImageStream& stream,
                            const std::vector<ImageHeader>& named,
                            ProblemList& problems) {
  const auto there = static_cast<std::size_t>(std::count_if(
      named.begin(), named.end(),
      [](const ImageHeader& header) { return header.state != ImageState::kMissing; }));
  const std::size_t files = count_images(stream.folder);
  if (files <= there) return;
  problems.warning(stream.folder.string(), 0, "images",
                   std::to_string(files) + " files for " + std::to_string(named.size()) +
                       " rows of data.csv; " + std::to_string(files - there) +
                       " files without a row are not used",
                   "a row for each image");
}

// The range of the 16-bit images among those that can be used.
std::optional<GreyRange> greys_of(const ImageStream& stream,
                                  const std::vector<std::int64_t>& deep_ns,
                                  int num_threads) {
  std::vector<std::filesystem::path> files;
  for (const std::int64_t t_ns : deep_ns) files.push_back(stream.folder / stream.names.at(t_ns));
  return measured_grey_range(files, num_threads);
}

bool read_file(const std::filesystem::path& file, std::vector<std::uint8_t>& content) {
  constexpr std::uint64_t kLargest = 1u << 30;
  const RegularFile in(file);
  if (!in || in.size() > kLargest) return false;
  content.resize(in.size());
  return std::fread(content.data(), 1, content.size(), in.get()) == content.size();
}

// The same size and tail, and then the same bytes.
bool same_content(const ImageStream& stream,
                  const ImageRow& a,
                  const ImageHeader& a_header,
                  const ImageRow& b,
                  const ImageHeader& b_header) {
  if (a_header.bytes != b_header.bytes || a_header.tail != b_header.tail) return false;
  std::vector<std::uint8_t> a_bytes;
  std::vector<std::uint8_t> b_bytes;
  return read_file(stream.folder / stream.names.at(a.t_ns), a_bytes) &&
         read_file(stream.folder / stream.names.at(b.t_ns), b_bytes) && a_bytes == b_bytes;
}

// Of a camera that hangs: even at rest the images of a real camera differ by its noise.
std::vector<RepeatedImages> find_repeats(const ImageStream& stream,
                                         const std::vector<ImageRow>& rows,
                                         const std::vector<ImageHeader>& headers) {
  constexpr std::size_t kFewest = 5;
  std::vector<RepeatedImages> repeats;
  RepeatedImages run;
  const auto close = [&] {
    if (run.count >= kFewest) repeats.push_back(run);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool again = i > 0 && headers[i].state == ImageState::kGood &&
                       same_content(stream, rows[i - 1], headers[i - 1], rows[i], headers[i]);
    if (!again) {
      close();
      run = {0, rows[i].t_ns, 0, rows[i].line};
    }
    ++run.count;
    run.last_ns = rows[i].t_ns;
  }
  close();
  return repeats;
}

}  // namespace

void ImageNames::add(std::int64_t t_ns, const std::string& name) {
  if (!has_rule_) {
    const auto dot = name.find('.');
    digits_ = dot == std::string::npos ? 0 : dot;
    extension_ = dot == std::string::npos ? "" : name.substr(dot);
    has_rule_ = true;
  }
  if (by_rule(t_ns) != name) others_.emplace(t_ns, name);
}

std::string ImageNames::at(std::int64_t t_ns) const {
  const std::int64_t named_ns = t_ns - shift_ns_;
  const auto other = others_.find(named_ns);
  return other == others_.end() ? by_rule(named_ns) : other->second;
}

void ImageStream::shift(std::int64_t by_ns) {
  shifted_ns += by_ns;
  for (std::int64_t& t_ns : stamps_ns) t_ns += by_ns;
  for (RepeatedImages& run : repeats) {
    run.first_ns += by_ns;
    run.last_ns += by_ns;
  }
  names.shift(by_ns);
}

std::string ImageNames::by_rule(std::int64_t t_ns) const {
  std::string digits = std::to_string(t_ns);
  if (digits.size() < digits_) digits.insert(0, digits_ - digits.size(), '0');
  return digits + extension_;
}

ImageStream load_image_stream(const std::filesystem::path& sensor_folder,
                              const ImageSize& size,
                              const StampLimits& limits,
                              const DriveOptions& options,
                              ProblemList& problems) {
  ImageStream stream;
  stream.folder = sensor_folder / "data";
  const std::filesystem::path table = sensor_folder / "data.csv";
  const std::size_t errors_at_start = problems.error_count();
  const auto rows = read_rows(table, limits, stream, problems);
  std::vector<ImageHeader> headers(rows.size());
  parallel_for(rows.size(), options.num_threads, [&](std::size_t i) {
    headers[i] = inspect_image(stream.folder / stream.names.at(rows[i].t_ns));
  });
  Sha256 digest;
  std::vector<std::int64_t> deep_ns;
  OtherSizes other_sizes(size);
  const std::size_t errors_before = problems.error_count();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string name = stream.names.at(rows[i].t_ns);
    digest.update(rows[i].t_ns).update(name).update(std::uint64_t{headers[i].bytes});
    if (!too_large(headers[i], options.max_image_megapixels) &&
        other_sizes.add(headers[i], rows[i], name))
      continue;
    if (accept(headers[i], rows[i], table.string(), name, options.max_image_megapixels, problems)) {
      stream.stamps_ns.push_back(rows[i].t_ns);
      if (headers[i].bits == 16) deep_ns.push_back(rows[i].t_ns);
    }
  }
  stream.greys = greys_of(stream, deep_ns, options.num_threads);
  stream.digest = digest.hex();
  stream.repeats = find_repeats(stream, rows, headers);
  other_sizes.report(table.string(), problems);
  // Rows that were refused named images too.
  if (!rows.empty() && errors_before == errors_at_start)
    warn_of_unnamed_images(stream, headers, problems);
  if (problems.error_count() == errors_before) warn_of_share(stream, rows.size(), problems);
  if (!rows.empty() && stream.stamps_ns.empty() && problems.error_count() == errors_before)
    problems.error(table.string(), 0, "images",
                   "none of " + std::to_string(rows.size()) + " usable", "at least one");
  return stream;
}

void warn_of_grey_range(const ImageStream& stream, ProblemList& problems) {
  if (!stream.greys || stream.greys->span == GreyRange{}.span) return;
  const auto& [black, span] = *stream.greys;
  problems.warning(stream.folder.string(), 0, "images",
                   "16-bit greys of which " + std::to_string(black) + " to " +
                       std::to_string(black + span - 1) + " are used; they are read as 0 to 255",
                   "all 16 bits in use, or 8-bit images");
}

namespace {

cv::Mat decode_any(const std::vector<std::uint8_t>& content,
                   const ImageHeader& header,
                   const GreyRange& greys) {
  if (auto grey = decode_grey_png(content, header)) return *grey;
  if (auto grey = decode_grey_jpeg(content, header)) return *grey;
  // What libjpeg refused OpenCV would fill up; only CMYK is left to it.
  if (header.format == ImageFormat::kJpeg && header.channels != 4) return {};
  // libpng would refuse the file too, but it would print a line on standard error.
  const bool plain_grey = header.channels == 1 && header.bits == 8 && !header.interlaced;
  if (header.format == ImageFormat::kPng && (plain_grey || !png_chunks_whole(content))) return {};
  try {
    if (header.bits != 16)
      return cv::imdecode(content, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    const cv::Mat deep = cv::imdecode(
        content, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
    return deep.type() == CV_16UC1 ? to_8_bits(deep, greys) : deep;
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

cv::Mat decode_image_file(const std::filesystem::path& file,
                          const ImageSize& size,
                          std::string& why,
                          const GreyRange& greys) {
  thread_local std::vector<std::uint8_t> content;
  if (!read_file(file, content)) {
    why = to_text(ImageState::kMissing);
    return {};
  }
  const ImageHeader header = inspect_image(std::span<const std::uint8_t>(content));
  if (header.state != ImageState::kGood) {
    why = to_text(header.state);
    return {};
  }
  if (header.width != size.width || header.height != size.height) {
    why = size_text(header.width, header.height) + " pixels";
    return {};
  }
  cv::Mat image = decode_any(content, header, greys);
  if (image.type() != CV_8UC1 || image.cols != size.width || image.rows != size.height)
    image.release();
  if (image.empty()) why = "damaged pixels";
  return image;
}

}  // namespace roadbook
