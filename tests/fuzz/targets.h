// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

// One function for each kind of input that comes from outside. It reads the bytes as the programs do, and looks at all that came
// out: an index out of its range is a fault that a sanitizer sees. A fuzzer calls it with bytes it invents (entry.cpp), a test
// with the files of corpus/ (corpus_test.cpp).
namespace palpate::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// @return whether the input was taken: what refuses inputs has said no by an exception of its own
/// @throw std::logic_error  what was taken is not what its reader promises. Any other exception is a fault too
bool answer(Bytes input);  ///< what the process that parses a model file says of it: changes of a good answer
bool cases(Bytes input);   ///< case file of palpate-solve
bool config(Bytes input);  ///< configuration file of palpate-server
bool http(Bytes input);    ///< headers that palpate-viewer judges: a line each
bool journal(Bytes input);     ///< parts of a solve that was interrupted
bool medit(Bytes input);       ///< mesh file of Medit
bool model(Bytes input);       ///< model file, once HDF5 has read it: changes of a good one
bool msh(Bytes input);         ///< mesh file of Gmsh
bool obj(Bytes input);         ///< surface file of Wavefront
bool organ(Bytes input);       ///< a model as model() has, all digests right, made into an organ and pressed
bool page(Bytes input);        ///< message of palpate-viewer's page
bool parameters(Bytes input);  ///< parameter requests and announcements of tools
bool poses(Bytes input);       ///< poses as DDS hands them over
bool recording(Bytes input);   ///< file of palpate-server --record
bool stl(Bytes input);         ///< surface file, STL
bool surface(Bytes input);     ///< organ's surface as a server sends it to clients
bool uri(Bytes input);         ///< path that a browser asks palpate-viewer for
bool vtk(Bytes input);         ///< mesh file, legacy VTK

struct Target {
  const char* name;
  bool (*read)(Bytes);
};
inline constexpr std::array<Target, 18> kTargets{{{"answer", answer},
                                                  {"cases", cases},
                                                  {"config", config},
                                                  {"http", http},
                                                  {"journal", journal},
                                                  {"medit", medit},
                                                  {"model", model},
                                                  {"msh", msh},
                                                  {"obj", obj},
                                                  {"organ", organ},
                                                  {"page", page},
                                                  {"parameters", parameters},
                                                  {"poses", poses},
                                                  {"recording", recording},
                                                  {"stl", stl},
                                                  {"surface", surface},
                                                  {"uri", uri},
                                                  {"vtk", vtk}}};

/// Corrects the checksums in an input of recording() and journal(): no fuzzer finds these by chance.
void mendRecording(std::span<std::uint8_t> input);
void mendJournal(std::span<std::uint8_t> input);

/// Calls it, and looks how much of the processor it took. @param most  s
/// @throw std::logic_error  it took more, so that small inputs could keep a program busy
bool soonEnough(bool (*read)(Bytes), Bytes input, double most);

/// @throw std::logic_error
void require(bool good, const char* what);

/// Takes numbers from the front of an input; zeros behind its end.
class Source {
 public:
  explicit Source(Bytes input) : rest_(input) {}
  [[nodiscard]] bool empty() const { return rest_.empty(); }

  [[nodiscard]] Bytes take(std::size_t size) {
    const Bytes front = rest_.first(size < rest_.size() ? size : rest_.size());
    rest_ = rest_.subspan(front.size());
    return front;
  }
  template <class T>
  [[nodiscard]] T get() {
    T value{};
    const Bytes from = take(sizeof(T));
    if (!from.empty()) std::memcpy(&value, from.data(), from.size());
    return value;
  }
  [[nodiscard]] std::string text(std::size_t size) {
    const Bytes from = take(size);
    return {from.begin(), from.end()};
  }

 private:
  Bytes rest_;
};

}  // namespace palpate::fuzz
