// SPDX-License-Identifier: Apache-2.0
#include "export_page.h"

#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "page_files.h"
#include "palpate/client/error.h"

namespace palpate::viewer {
namespace fs = std::filesystem;
namespace {

constexpr std::array kCore{"core/palpate_core.mjs", "core/palpate_core.wasm"};
constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1a\n";  // how a file begins; HDF5 file format, II.A
constexpr std::string_view kEndOfHead = "</head>";

void checkCore(const fs::path& page) {
  for (const char* file : kCore)
    if (!fs::is_regular_file(page / file))
      throw client::ClientError("the page in " + page.string() + " has no " + file +
                                ", without which it opens no model: build it where emscripten is installed "
                                "(tools/install_packages)");
}

void checkModel(const fs::path& model, const fs::path& page) {
  if (!fs::is_regular_file(model)) throw client::ClientError("--model " + model.string() + " is not a file");
  std::ifstream file(model, std::ios::binary);
  std::array<char, kHdf5.size()> start{};
  if (!file.read(start.data(), start.size()) || std::string_view(start.data(), start.size()) != kHdf5)
    throw client::ClientError("--model " + model.string() +
                              " cannot be read, or is not a model: it does not begin as HDF5 files do");
  if (fs::exists(page / model.filename()))
    throw client::ClientError("--model " + model.string() + " has the name of a file of the page");
}

/// A file's name in an address, without what HTML or URLs would take for their own.
std::string encoded(std::string_view name) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) != 0 || c == '-' || c == '_' || c == '.'))
      out += c;
    else
      (out += '%').append({kDigits[byte / 16], kDigits[byte % 16]});
  }
  return out;
}

/// index.html, which says that no palpate-viewer serves it, and which model to open.
void nameModel(const fs::path& index, const fs::path& model) {
  std::ifstream in(index, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t at = text.find(kEndOfHead);
  if (at == text.npos) throw client::ClientError(index.string() + " has no " + std::string(kEndOfHead));
  text.insert(at, "  <meta name=\"palpate-model\" content=\"" +
                      (model.empty() ? "" : "./" + encoded(model.filename().string())) + "\" />\n  ");
  std::ofstream out(index, std::ios::binary);
  if (!out.write(text.data(), static_cast<std::streamsize>(text.size())).flush())
    throw client::ClientError("cannot write " + index.string());
}

Exported sizeOf(const fs::path& folder) {
  Exported written;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) {
      ++written.files;
      written.bytes += entry.file_size();
    }
  return written;
}

/// The outermost of the folders that have to be made. @return empty: the folder is there
fs::path outermostNew(const fs::path& folder) {
  fs::path made;
  for (fs::path at = fs::absolute(folder).lexically_normal(); !at.empty() && !fs::exists(at);
       at = at.parent_path())
    made = at;
  return made;
}

void clear(const fs::path& folder, const fs::path& made) {
  std::error_code ignored;
  if (!made.empty()) fs::remove_all(made, ignored);
  if (made.empty())
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
      fs::remove_all(entry.path(), ignored);
}

/// A copy of the page into itself would never end.
void checkOutside(const fs::path& page, const fs::path& folder) {
  const fs::path inside = fs::weakly_canonical(folder).lexically_relative(fs::weakly_canonical(page));
  if (!inside.empty() && *inside.begin() != "..")
    throw client::ClientError("--export " + folder.string() + " is inside the page's folder " +
                              page.string());
}

void copyAll(const fs::path& page, const fs::path& folder, const fs::path& model) {
  fs::create_directories(folder);
  fs::copy(page, folder, fs::copy_options::recursive);
  if (!model.empty()) fs::copy_file(model, folder / model.filename());
  nameModel(folder / "index.html", model);
}

}  // namespace

void checkFolders(const fs::path& page, const fs::path& folder) {
  const fs::path from = PageFiles(page).folder();
  checkCore(from);
  if (folder.empty()) throw client::ClientError("--export names no folder");
  if (fs::exists(folder) && (!fs::is_directory(folder) || !fs::is_empty(folder)))
    throw client::ClientError("--export " + folder.string() + " is not an empty folder");
  checkOutside(from, folder);
}

Exported exportPage(const fs::path& page, const fs::path& folder, const fs::path& model) {
  checkFolders(page, folder);
  const fs::path from = PageFiles(page).folder();
  if (!model.empty()) checkModel(model, from);
  const fs::path made = outermostNew(folder);
  try {
    copyAll(from, folder, model);
    return sizeOf(folder);
  } catch (const fs::filesystem_error& error) {
    clear(folder, made);
    throw client::ClientError("--export " + folder.string() + ": cannot write " +
                              (error.path2().empty() ? error.path1() : error.path2()).string() + ": " +
                              error.code().message());
  } catch (...) {
    clear(folder, made);
    throw;
  }
}

}  // namespace palpate::viewer
