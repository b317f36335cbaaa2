// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "palpate/idl/participant.h"
#include "palpate/idl/types.h"

namespace palpate::client {

/// Sends a request every 200 ms, under one new request_id, until the server answers, and listens for 200 ms more for a second server of
/// the same id, unless the request names a session.
/// A participant whose role may send none gets what is in force, if that is all that is asked (fields 0, no model): the newest
/// answer is kept for late readers.
/// @param[in] request  server_id, fields and values, or model
/// @return the server's answer, accepted or not, never one that says that another follows
/// @throw ClientError  for `patience` no answer, nor a word that it follows; the user interrupted; its role may not ask for a
/// change; dds::DdsError
/// Real-time: no.
[[nodiscard]] dds::ServerParameters exchangeParameters(const dds::Participant& participant,
                                                       dds::ParameterRequest request,
                                                       std::chrono::milliseconds patience);

}  // namespace palpate::client
