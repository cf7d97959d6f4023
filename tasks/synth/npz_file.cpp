#include "tasks/synth/npz_file.h"

#include <zip.h>

#include <array>
#include <memory>
#include <utility>

#include "numerics/errors.h"
#include "numerics/files/npy_file.h"
#include "numerics/files/output_file.h"

namespace astrolith {
namespace {

constexpr int kLevel = 1;                          // of zlib; higher levels save some percent only
constexpr std::uint16_t kFirstDay = (1 << 5) | 1;  // 1 January 1980, where the dates of zip archives begin

struct DiscardArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Archive = std::unique_ptr<zip_t, DiscardArchive>;
using Source = std::unique_ptr<zip_source_t, FreeSource>;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
  throw WorkError(file.string() + ": cannot be packed: " + reason);
}

Source make_source(const void* data, std::size_t bytes, const std::filesystem::path& file) {
  zip_error_t error;
  zip_error_init(&error);
  Source source(zip_source_buffer_create(data, bytes, 0, &error));
  if (!source) fail(file, zip_error_strerror(&error));
  return source;
}

std::string npy_bytes(const NpzArray& array) {
  return npy_header(array.type, array.shape)
      .append(reinterpret_cast<const char*>(array.values.data()), array.values.size());
}

// The archive only refers to `bytes`, which must live until it is closed.
void add(zip_t* archive, const std::string& name, const std::string& bytes,
         const std::filesystem::path& file) {
  Source source = make_source(bytes.data(), bytes.size(), file);
  const zip_int64_t index = zip_file_add(archive, (name + ".npy").c_str(), source.get(), ZIP_FL_ENC_UTF_8);
  if (index < 0) fail(file, zip_strerror(archive));
  static_cast<void>(source.release());  // the archive owns it now
  const auto number = static_cast<zip_uint64_t>(index);
  if (zip_set_file_compression(archive, number, ZIP_CM_DEFLATE, kLevel) != 0 ||
      zip_file_set_dostime(archive, number, 0, kFirstDay, 0) != 0) {
    fail(file, zip_strerror(archive));
  }
}

void copy(zip_source_t* packed, const std::filesystem::path& file) {
  OutputFile out(file);
  if (zip_source_open(packed) != 0) fail(file, zip_error_strerror(zip_source_error(packed)));
  std::array<char, 1 << 16> buffer;
  zip_int64_t bytes = 0;
  while ((bytes = zip_source_read(packed, buffer.data(), buffer.size())) > 0) {
    out.write(buffer.data(), static_cast<std::size_t>(bytes));
  }
  zip_source_close(packed);
  if (bytes < 0) fail(file, zip_error_strerror(zip_source_error(packed)));
  out.commit();
}

template <typename T>
NpzArray array_of(std::string name, const char* type, std::vector<int> shape, std::span<const T> values) {
  return {std::move(name), type, std::move(shape), std::as_bytes(values)};
}

}  // namespace

NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const float> values) {
  return array_of(std::move(name), "<f4", std::move(shape), values);
}
NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const double> values) {
  return array_of(std::move(name), "<f8", std::move(shape), values);
}
NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const std::int8_t> values) {
  return array_of(std::move(name), "|i1", std::move(shape), values);
}
NpzArray npz_array(std::string name, std::vector<int> shape, std::span<const std::int32_t> values) {
  return array_of(std::move(name), "<i4", std::move(shape), values);
}

void write_npz(std::span<const NpzArray> arrays, const std::filesystem::path& file) {
  std::vector<std::string> contents;
  for (const NpzArray& array : arrays) {
    const std::size_t bytes_of_one = static_cast<std::size_t>(array.type.back() - '0');
    if (array.values.size() != npy_size(array.shape) * bytes_of_one)
      throw WorkError(file.string() + ": " + array.name + ": the array does not have the stated shape");
    contents.push_back(npy_bytes(array));
  }
  const Source packed = make_source(nullptr, 0, file);
  zip_error_t error;
  zip_error_init(&error);
  zip_source_keep(packed.get());  // read once the archive, which owns one reference, is closed
  Archive archive(zip_open_from_source(packed.get(), ZIP_TRUNCATE, &error));
  if (!archive) {
    zip_source_free(packed.get());
    fail(file, zip_error_strerror(&error));
  }
  for (std::size_t i = 0; i < contents.size(); ++i) add(archive.get(), arrays[i].name, contents[i], file);
  if (zip_close(archive.get()) != 0) fail(file, zip_strerror(archive.get()));
  static_cast<void>(archive.release());
  copy(packed.get(), file);
}

}  // namespace astrolith
