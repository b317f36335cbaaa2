// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::feel {

/// The options of the command line.
struct Study {
  std::string model;
  unsigned seed{1};
  int count{1000};           ///< loops of each kind
  int paths{100};            ///< slides of each kind
  double depth{0.002};       ///< m
  double speed{0.05};        ///< m/s
  bool frictionless{false};  ///< devices without their own Coulomb friction
  bool json{false};
};

// Each runs a study, prints a table or JSON, and returns the program's exit code, 0 for any result.
// @throw LoadError
int runLoops(const Study& study);
int runSlides(const Study& study);
int runCoupling(const Study& study);

}  // namespace palpate::feel
