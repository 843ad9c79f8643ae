#include "exchange/layers/feature_column.hpp"

#include <cstring>

namespace roadbook {

FieldValue feature_to_field(const Eigen::VectorXf& feature) {
  Bytes bytes(static_cast<std::size_t>(feature.size()) * sizeof(float));
  std::memcpy(bytes.data(), feature.data(), bytes.size());
  return bytes;
}

Eigen::VectorXf feature_from_row(const TableRow& row,
                                 const std::string& column,
                                 Eigen::Index size) {
  const Bytes& bytes = row.get<Bytes>(column);
  const auto count = static_cast<Eigen::Index>(bytes.size() / sizeof(float));
  if (bytes.empty() || bytes.size() % sizeof(float) != 0 || (size > 0 && count != size))
    row.fail(column, std::to_string(bytes.size()) + " bytes");
  Eigen::VectorXf feature(count);
  std::memcpy(feature.data(), bytes.data(), bytes.size());
  if (!feature.allFinite()) row.fail(column, "a value that is no number");
  return feature;
}

}  // namespace roadbook
