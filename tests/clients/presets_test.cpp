// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palpate/core/device_preset.h"
#include "palpate/device/mechanics.h"

namespace palpate::device {
namespace {

// Two tables, because clients may not link core: what the server knows of a device and what a simulation needs.
TEST(Presets, AreThoseOfTheServer) {
  EXPECT_EQ(presets().size(), devicePresets().size());
  for (const DevicePreset& preset : devicePresets()) EXPECT_TRUE(findPreset(preset.name)) << preset.name;
}

}  // namespace
}  // namespace palpate::device
