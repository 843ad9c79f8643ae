#include "drive/images/jpeg_grey.hpp"

#include <csetjmp>
#include <cstdio>

// jpeglib.h needs <cstdio> before it.
#include <jerror.h>
#include <jpeglib.h>

namespace roadbook {
namespace {

// libjpeg reports through callbacks that must not return; longjmp leaves them. Nothing between
// setjmp and longjmp has a destructor.
struct Errors {
  jpeg_error_mgr base;  ///< first: libjpeg knows only this part
  std::jmp_buf escape;
};

void give_up(j_common_ptr info) { std::longjmp(reinterpret_cast<Errors*>(info->err)->escape, 1); }

// Level -1 is "corrupt data"; the two exceptions concern version and colour tags, not pixels.
void on_message(j_common_ptr info, int level) {
  if (level >= 0) return;
  const int code = info->err->msg_code;
  if (code != JWRN_JFIF_MAJOR && code != JWRN_ADOBE_XFORM) give_up(info);
}

bool decode(std::span<const std::uint8_t> content, cv::Mat& image) {
  Errors errors{};
  jpeg_decompress_struct info{};  // zeros: it may be destroyed before it was created
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = &give_up;
  errors.base.emit_message = &on_message;
  if (setjmp(errors.escape) != 0) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, content.data(), content.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&info);
  const bool fits = info.output_width == static_cast<JDIMENSION>(image.cols) &&
                    info.output_height == static_cast<JDIMENSION>(image.rows) &&
                    info.output_components == 1;
  while (fits && info.output_scanline < info.output_height) {
    JSAMPROW row = image.ptr<std::uint8_t>(static_cast<int>(info.output_scanline));
    jpeg_read_scanlines(&info, &row, 1);
  }
  if (fits) jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return fits;
}

}  // namespace

std::optional<cv::Mat> decode_grey_jpeg(std::span<const std::uint8_t> content,
                                        const ImageHeader& header) {
  // Of four channels (CMYK) libjpeg makes no grey.
  if (header.state != ImageState::kGood || header.format != ImageFormat::kJpeg ||
      header.bits != 8 || header.channels == 2 || header.channels == 4)
    return std::nullopt;
  cv::Mat image(static_cast<int>(header.height), static_cast<int>(header.width), CV_8UC1);
  if (!decode(content, image)) return std::nullopt;
  return image;
}

}  // namespace roadbook
