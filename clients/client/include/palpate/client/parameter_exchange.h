// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "palpate/idl/participant.h"
#include "palpate/idl/types.h"

namespace palpate::client {

/// Sends a request every 200 ms, under one new request_id, until the server answers.
/// @param[in] request  server_id, fields and values, or model
/// @return the server's answer, accepted or not, never one that says that another follows
/// @throw ClientError  for `patience` no answer, nor a word that it follows; the user interrupted; dds::DdsError
/// Real-time: no.
[[nodiscard]] dds::ServerParameters exchangeParameters(const dds::Participant& participant,
                                                       dds::ParameterRequest request,
                                                       std::chrono::milliseconds patience);

}  // namespace palpate::client
