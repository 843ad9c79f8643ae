#pragma once

namespace roadbook {

// What honest wheels may be off by, when the cameras judge them. Radii and track are known to some
// percent, corners to some pixels.

constexpr double kWheelSigmas = 4.0;      ///< beyond which wheels are doubted
constexpr double kOfTurn = 0.04;          ///< 1 sigma, of the turn
constexpr double kOfWay = 0.05;           ///< 1 sigma, of the way
constexpr double kLeastTurn_rad = 0.004;  ///< 1 sigma, of any turn
constexpr double kLeastWay_m = 0.02;      ///< 1 sigma, of any way
constexpr int kFewestInliers = 20;        ///< corners with which the cameras know a motion

}  // namespace roadbook
