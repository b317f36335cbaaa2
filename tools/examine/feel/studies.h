// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palpate::feel {

/// The options of the command line.
struct Study {
  std::string model;
  unsigned seed{1};
  int count{1000};            ///< loops of each kind
  int paths{100};             ///< slides of each kind
  double depth{0.002};        ///< m
  double speed{0.05};         ///< m/s
  bool frictionless{false};   ///< devices without their own Coulomb friction
  std::string delay_from;     ///< coupling: file of palpate-latency --samples; empty: one period
  std::string preset;         ///< coupling: one device; empty: all
  std::string settings;       ///< coupling under delays: folder for the servers' configurations; empty: none
  std::string without;        ///< contrast: model of the same organ without its regions
  double press_depth{0.005};  ///< contrast, m
  std::string map;            ///< contrast: .svg or .vtu; empty: none
  bool json{false};
};

// Each runs a study, prints a table or JSON, and returns the program's exit code, 0 for any result.
// @throw LoadError; runContrast also ModelsDiffer, program::ValueError for the map's name, program::WriteError
int runLoops(const Study& study);
int runSlides(const Study& study);
int runCoupling(const Study& study);
int runContrast(const Study& study);

}  // namespace palpate::feel
