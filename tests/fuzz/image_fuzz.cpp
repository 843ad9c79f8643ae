#include <opencv2/core/mat.hpp>

#include "drive/images/image_header.hpp"
#include "drive/images/image_stream.hpp"
#include "drive/images/jpeg_grey.hpp"
#include "drive/images/png_grey.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> content(data, size);
  const ImageHeader header = inspect_image(content);
  (void)png_chunks_whole(content);
  // Drives refuse larger images before they are decoded; what remains is quick to fuzz.
  if (header.width * header.height > 1'000'000) return 0;
  (void)decode_grey_png(content, header);
  (void)decode_grey_jpeg(content, header);
  const fuzz::fs::path file = fuzz::work_folder() / "image";
  fuzz::put(file, fuzz::text_of(data, size));
  std::string why;
  const ImageSize stated{static_cast<int>(header.width), static_cast<int>(header.height)};
  (void)decode_image_file(file, stated, why);
  return 0;
}
