// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libwebsockets.h>

#include <string>
#include <string_view>

#include "page_files.h"

namespace palpate::viewer {

/// A request's header; empty when absent or longer than 1 kB. Headers of the same name come joined.
[[nodiscard]] std::string headerOf(lws* wsi, lws_token_indexes header);

/// Value of ?token=; empty when absent.
[[nodiscard]] std::string tokenOf(lws* wsi);

/// Whether a comma-separated list has the name.
[[nodiscard]] bool names(std::string_view list, std::string_view name);

/// Headers of a file's response: what the page may load, and from where. @param[in] host  our own, checked
[[nodiscard]] std::string headersOf(const PageFile& file, const std::string& host);

/// Answers with an error page. @return the callback's result
int refuse(lws* wsi, unsigned code, const char* reason);
int refuseUpgrade(lws* wsi, unsigned code, const char* reason);

}  // namespace palpate::viewer
