#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/random.hpp"
#include "drive/drive.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "semantics/oriented_box.hpp"
#include "semantics/overhead/geotiff_writer.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook::test {

/// The class that its spaces are labelled with.
inline constexpr const char* kSpace = "parking_space";

/// A painted car park with a map: aisles along x, spaces on both sides, a drive through each aisle.
struct Lot {
  int aisles = 1;
  int spaces_a_side = 10;
  double aisle_apart_m = 24.0;
  double resolution_m = 0.04;
  int side_px = 0;                   ///< of the overhead image; 0: as large as the lot
  std::filesystem::path drive = {};  ///< the recording, beside the map file; empty: none
  /// All poses of a map that is built again: moved along x, then turned about the origin.
  double moved_m = 0.0;
  double turned = 0.0;
};

constexpr double kSpaceLengthM = 5.0;
constexpr double kSpaceWidthM = 2.5;
constexpr double kAisleHalfM = 3.0;

inline std::vector<OrientedBox> spaces_of(const Lot& lot) {
  std::vector<OrientedBox> spaces;
  for (int aisle = 0; aisle < lot.aisles; ++aisle)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < lot.spaces_a_side; ++i) {
        OrientedBox box;
        box.centre = {(i + 0.5) * kSpaceWidthM,
                      aisle * lot.aisle_apart_m + side * (kAisleHalfM + 0.5 * kSpaceLengthM)};
        box.heading = side * 0.5 * 3.14159265358979;
        box.length_m = kSpaceLengthM;
        box.width_m = kSpaceWidthM;
        spaces.push_back(box);
      }
  return spaces;
}

inline Map lot_map(const Lot& lot) {
  Map map;
  const Eigen::Isometry3d T_anew =
      pose_from_planar(0.0, 0.0, lot.turned) * pose_from_planar(lot.moved_m, 0.0, 0.0);
  Session session;
  session.name = "lot";
  session.drive_path = "no_such_drive";
  session.drive_digest = "0";
  if (!lot.drive.empty()) {
    session.drive_path = lot.drive.filename().string();
    session.drive_digest = Drive::open(lot.drive).digest();
  }
  session.rig = fisheye_rig();
  session.t_begin_ns = 1'400'000'000'000'000'000;
  for (int aisle = 0; aisle < lot.aisles; ++aisle)
    for (int i = -2; i < lot.spaces_a_side * 3 + 2; ++i) {
      Keyframe k;
      k.t_ns = session.t_begin_ns +
               static_cast<std::int64_t>(map.keyframes.size()) * std::int64_t{100'000'000};
      k.map_frame = k.drive_frame = static_cast<int>(map.keyframes.size());
      k.covariance.setZero();
      k.covariance.diagonal().setConstant(1e-4);
      map.map_frames.push_back(
          {T_anew * pose_from_planar(i * kSpaceWidthM / 3.0, aisle * lot.aisle_apart_m, 0.0)});
      map.keyframes.push_back(k);
      session.t_end_ns = k.t_ns;
    }
  map.sessions.push_back(session);
  return map;
}

/// Grey ground with a grain; white lines between spaces and along their far ends.
class LotPicture {
 public:
  explicit LotPicture(const Lot& lot) : lot_(lot) {
    const double width = lot.spaces_a_side * kSpaceWidthM + 8.0;
    const double height = (lot.aisles - 1) * lot.aisle_apart_m + 24.0;
    place_.resolution_m = lot.resolution_m;
    const int least = static_cast<int>(std::max(width, height) / lot.resolution_m);
    place_.columns = place_.rows = lot.side_px > 0 ? lot.side_px : least;
    place_.west_m = -4.0;
    place_.north_m = height - 12.0;
  }
  [[nodiscard]] const RasterPlace& place() const { return place_; }

  [[nodiscard]] std::uint8_t at(int column, int row) const {
    const double x = place_.west_m + (column + 0.5) * place_.resolution_m;
    const double y = place_.north_m - (row + 0.5) * place_.resolution_m;
    // A grain that repeats: a big picture of it stays small in the file.
    const int grain = ((column % 61) * 37 + (row % 53) * 91) % 23;
    return static_cast<std::uint8_t>((is_line(x, y) ? 190 : 90) + grain);
  }

 private:
  [[nodiscard]] bool is_line(double x, double y) const {
    const double aisle = std::clamp(std::round(y / lot_.aisle_apart_m), 0.0, lot_.aisles - 1.0);
    const double across = std::abs(y - aisle * lot_.aisle_apart_m);
    const double end = lot_.spaces_a_side * kSpaceWidthM;
    if (across < kAisleHalfM || across > kAisleHalfM + kSpaceLengthM) return false;
    if (x < -0.06 || x > end + 0.06) return false;
    const double beside = std::abs(x - kSpaceWidthM * std::round(x / kSpaceWidthM));
    return beside < 0.06 || across > kAisleHalfM + kSpaceLengthM - 0.12;
  }

  Lot lot_;
  RasterPlace place_;
};

/// Gives a map file the overhead image.
inline void write_lot_picture(const std::filesystem::path& file, const Lot& lot) {
  const LotPicture picture(lot);
  const auto tiff = file.parent_path() / "overhead.tif";
  {
    constexpr int kBlock = GeoTiffWriter::kBlock;
    GeoTiffWriter writer(tiff, picture.place(), PixelType::kByte, 1, 0.0, "lot");
    std::vector<std::uint8_t> block(kBlock * kBlock);
    for (int row = 0; row * kBlock < picture.place().rows; ++row)
      for (int column = 0; column * kBlock < picture.place().columns; ++column) {
        for (int i = 0; i < kBlock * kBlock; ++i)
          block[static_cast<std::size_t>(i)] =
              picture.at(column * kBlock + i % kBlock, row * kBlock + i / kBlock);
        writer.write_block(1, column, row, block.data());
      }
    writer.finish(OverviewMethod::kAverage);
  }
  MapUpdate update(file);
  update.write_raster("overhead", tiff);
  update.commit();
  std::filesystem::remove(tiff);
}

/// Writes the map with its overhead image.
inline void write_lot(const std::filesystem::path& file, const Lot& lot) {
  MapFileBuilder(file, "lot").finish(lot_map(lot), {});
  write_lot_picture(file, lot);
}

}  // namespace roadbook::test
