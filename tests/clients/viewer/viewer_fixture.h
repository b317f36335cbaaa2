// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "palpate/testing/server_process.h"
#include "palpate/testing/synthetic_model.h"
#include "palpate/testing/test_domain.h"
#include "palpate/testing/viewer_process.h"
#include "test_page.h"

namespace palpate::testing {

using std::chrono::milliseconds;
using std::chrono::seconds;

inline double sizeOf(const std::array<float, 3>& v) {
  return std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
}

/// palpate-server with an organ known in closed form, and palpate-viewer, as processes on a DDS domain of their own.
class ViewerEndToEnd : public ::testing::Test {
 protected:
  void startServer(int subdivisions = 3) { server_ = newServer(subdivisions); }
  [[nodiscard]] std::unique_ptr<ServerProcess> newServer(int subdivisions,
                                                         const std::vector<std::string>& more = {}) {
    SyntheticOptions options;
    options.subdivisions = subdivisions;
    options.nodule_above = 0.8;
    writeSyntheticModel(model_.path(), options);
    std::vector<std::string> arguments{"--model",        model_.path().string(),
                                       "--limit",        "youngs-modulus=100:1e9",
                                       "--domain",       domain_,
                                       "--device",       "custom",
                                       "--surface-rate", "100"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<ServerProcess>(arguments);
  }
  void startViewer(const std::vector<std::string>& more = {}) {
    viewer_ = std::make_unique<ViewerProcess>(domain_, more);
    ASSERT_NE(viewer_->port(), 0) << viewer_->announcement();
  }
  [[nodiscard]] WsRequest request() const {
    WsRequest request;
    request.port = viewer_->port();
    return request;
  }
  [[nodiscard]] std::unique_ptr<TestPage> openPage() const { return std::make_unique<TestPage>(request()); }

  // Server, viewer, and a page that shows the organ; the test fails where it does not.
  [[nodiscard]] std::unique_ptr<TestPage> openServedPage() {
    startServer();
    startViewer();
    auto page = openPage();
    EXPECT_TRUE(page->connect());
    return page;
  }
  // The same, and the page holds a tool.
  [[nodiscard]] std::unique_ptr<TestPage> openHoldingPage() {
    auto page = openServedPage();
    EXPECT_TRUE(grab(*page)["granted"]);
    return page;
  }

  // Asks for a tool and waits for the answer.
  static nlohmann::json grab(TestPage& page) {
    page.texts.erase("tool");
    page.client.say({{"type", "grab"}});
    return page.listen(seconds(5), [&] { return page.has("tool"); }) ? page.texts["tool"] : nlohmann::json();
  }
  // Whether the page still gets frames.
  static bool goesOn(TestPage& page) {
    const std::size_t before = page.frame_seqs.size();
    return page.listen(seconds(10), [&] { return page.frame_seqs.size() > before + 2; });
  }

  std::string domain_{std::to_string(exclusiveDomain())};
  TemporaryFile model_{"viewer-e2e.h5"};
  std::unique_ptr<ServerProcess> server_;
  std::unique_ptr<ViewerProcess> viewer_;
};

}  // namespace palpate::testing
