#pragma once

#include <Eigen/Core>
#include <string>

#include "exchange/layers/table_row.hpp"

namespace roadbook {

// Features of training examples in a column of a table: 32-bit floats, little-endian.

[[nodiscard]] FieldValue feature_to_field(const Eigen::VectorXf& feature);

/// Throws BadInput naming the column: no whole number of values or none at all, a value that is not
/// finite, other than `size` values (0: any number).
[[nodiscard]] Eigen::VectorXf feature_from_row(const TableRow& row,
                                               const std::string& column,
                                               Eigen::Index size = 0);

}  // namespace roadbook
