// SPDX-License-Identifier: Apache-2.0
#include "tools/modelfile/scale_model.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tools/modelfile/model_data.h"
#include "tools/modelfile/write_model.h"

namespace palpate::modelfile {

namespace {

template <class T>
std::vector<T> times(double factor, std::span<const T> numbers, const char* name) {
  std::vector<T> scaled(numbers.size());
  std::transform(numbers.begin(), numbers.end(), scaled.begin(),
                 [&](T number) { return static_cast<T>(factor * double{number}); });
  if (!std::all_of(scaled.begin(), scaled.end(), [](T number) { return std::isfinite(number); }))
    throw ModelFileError(std::string(name) + " has numbers that overflow at this E");
  return scaled;
}

/// A small file has floats where these are enough: scaled ones too.
std::vector<double> timesAsStored(double factor, std::span<const double> numbers, const char* name) {
  std::vector<double> scaled = times(factor, numbers, name);
  const bool floats = std::all_of(numbers.begin(), numbers.end(),
                                  [](double number) { return double{static_cast<float>(number)} == number; });
  if (floats)
    for (double& number : scaled) number = double{static_cast<float>(number)};
  return scaled;
}

}  // namespace

void writeScaled(const std::filesystem::path& path, const MetaModel& model, double E,
                 const std::string& provenance) {
  const double factor = E / model.attributes().E;
  const ModelView& from = model.view();
  const auto force = timesAsStored(factor, from.contact_force, "/contact/force"),
             stiffness = timesAsStored(factor, from.contact_stiffness, "/contact/stiffness"),
             region_E = times(factor, from.region_E, "/regions/E"),
             springs = times(factor, from.spring_stiffness, "/springs/stiffness");
  const auto green_Y = times(1.0 / factor, from.green_Y_scale, "/green/Y_scale"),
             green_near = times(1.0 / factor, from.green_near_scale, "/green/near_scale");
  ModelView view = from;
  view.contact_force = force;
  view.contact_stiffness = stiffness;
  view.region_E = region_E;
  view.spring_stiffness = springs;
  view.green_Y_scale = green_Y;
  view.green_near_scale = green_near;
  ModelAttributes attributes = model.attributes();
  attributes.E = E;
  attributes.provenance = provenance;
  attributes.certificate.clear();
  writeModel(path, attributes, view, isCompact(from));
}

}  // namespace palpate::modelfile
