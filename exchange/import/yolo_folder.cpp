#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "base/text_file.hpp"
#include "exchange/import/label_readers.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_below(const fs::path& folder,
                                  const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const std::string extension = it->path().extension().string();
    if (it->is_regular_file() &&
        std::find(extensions.begin(), extensions.end(), extension) != extensions.end())
      files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_named_overhead(const fs::path& file) {
  return file.stem().string().find("overhead") != std::string::npos;
}

std::string names_of_files(const std::vector<fs::path>& files) {
  std::string names;
  for (const fs::path& file : files)
    if (names.size() < 100) names += (names.empty() ? "" : ", ") + file.filename().string();
  return names;
}

}  // namespace

YoloFiles yolo_files(const fs::path& folder) {
  YoloFiles files;
  const fs::path plain = folder / "labels" / "overhead.txt";
  const fs::path labels = fs::is_directory(folder / "labels") ? folder / "labels" : folder;
  auto rows = files_below(labels, {".txt"});
  // Lists of a data set; some layouts store them in the folder of the labels.
  std::erase_if(rows, [](const fs::path& file) {
    const std::string name = file.filename().string();
    return name == "classes.txt" || name == "train.txt" || name == "val.txt" ||
           name == "valid.txt" || name == "test.txt" || name.starts_with("README");
  });
  std::vector<fs::path> overhead;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(overhead), is_named_overhead);
  if (fs::exists(plain)) overhead = {plain};
  if (overhead.size() > 1)
    throw BadInput({Severity::kError, labels.string(), 0, "rows of the overhead image",
                    names_of_files(overhead), "one file"});
  if (overhead.empty())
    throw BadInput({Severity::kError, plain.string(), 0, "",
                    rows.empty() ? "no such file" : names_of_files(rows) + " alone",
                    "rows of labels"});
  files.rows = overhead.front();
  std::erase(rows, files.rows);
  files.other = std::move(rows);
  const std::string stem = files.rows.stem().string();
  for (const fs::path& picture : files_below(folder, {".png", ".jpg", ".jpeg"}))
    if (picture.stem().string() == stem && files.picture.empty()) files.picture = picture;
  return files;
}

PicturePlace yolo_picture_place(const fs::path& folder, const MapLayers& layers) {
  const PicturePlace own = overhead_place(layers);
  const YoloFiles files = yolo_files(folder);
  const fs::path& picture_file = files.picture;
  if (picture_file.empty()) {
    const auto world = folder / "images" / "overhead.pgw";
    if (fs::exists(world)) return read_world_file(world, own.width, own.height);
    return own;
  }
  require_regular_file(picture_file, "a PNG or JPEG");
  const cv::Mat picture = cv::imread(picture_file.string(), cv::IMREAD_GRAYSCALE);
  if (picture.empty())
    throw BadInput(
        {Severity::kError, picture_file.string(), 0, "image", "no picture", "a PNG or JPEG"});
  const auto world = fs::path(picture_file).replace_extension(".pgw");
  if (fs::exists(world)) return read_world_file(world, picture.cols, picture.rows);
  require_size(picture_file.string(), own, picture.cols, picture.rows);
  return own;
}

}  // namespace roadbook
