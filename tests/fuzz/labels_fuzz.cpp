#include <memory>

#include "exchange/import/label_readers.hpp"
#include "mapping/layers/map_layers.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

namespace {

// Files of COCO and YOLO are about the overhead image of a map: $ROADBOOK_FUZZ_MAP.
const MapLayers* layers_of_map() {
  static const std::unique_ptr<const MapLayers> layers = [] {
    const char* const map = std::getenv("ROADBOOK_FUZZ_MAP");
    return map == nullptr ? nullptr : std::make_unique<const MapLayers>(map);
  }();
  return layers.get();
}

}  // namespace

// The first byte chooses the format. A YOLO folder has three files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = fuzz::text_of(data + 1, size - 1);
  const fuzz::fs::path file = fuzz::work_folder() / "labels.json";
  const MapLayers* const layers = layers_of_map();
  return fuzz::try_parse([&] {
    if (layers != nullptr && data[0] % 3 == 2) {
      const fuzz::fs::path folder = fuzz::work_folder() / "yolo";
      const auto parts = fuzz::parts_of(text, 3);
      fuzz::put(folder / "data.yaml", parts[0]);
      fuzz::put(folder / "labels" / "overhead.txt", parts[1]);
      fuzz::put(folder / "images" / "overhead.pgw", parts[2]);
      (void)read_yolo(folder, *layers);
      return;
    }
    fuzz::put(file, text);
    if (layers != nullptr && data[0] % 3 == 0)
      (void)read_coco(file, *layers);
    else
      (void)read_geojson(file, GeoOrigin{48.78, 9.18, 10.0}, "");
  });
}
