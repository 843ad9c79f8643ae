#include <ogrsf_frmts.h>

#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "mapping/layers/layer_styles.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/map_layers_vector.hpp"

namespace roadbook {

Paths export_gpkg(const std::filesystem::path& map,
                  const std::filesystem::path& out,
                  const ExportOptions& options) {
  const MapLayers layers(map);
  WholeFile output(out);
  const GdalScope scope(utc_text(0));
  GdalDataset dataset = create_geopackage(scope, output.part());
  for (const VectorLayer& layer : chosen_vector_layers(layers, options.layers))
    write_vector_layer(scope, *dataset, layer);
  dataset.reset();
  scope.check(out, "gpkg");
  write_layer_styles(SqlDatabase(output.part(), SqlMode::kReadWrite), utc_text(0));
  output.commit();
  return {out};
}

}  // namespace roadbook
