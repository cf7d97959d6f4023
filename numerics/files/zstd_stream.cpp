#include "numerics/files/zstd_stream.h"

#include <zstd.h>

#include <array>
#include <memory>
#include <new>
#include <vector>

#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr int kLevel = 3;  // the library's own default
constexpr std::size_t kPiece = std::size_t{1} << 17;

struct FreePacker {
  void operator()(ZSTD_CCtx* packer) const { ZSTD_freeCCtx(packer); }
};
struct FreeUnpacker {
  void operator()(ZSTD_DCtx* unpacker) const { ZSTD_freeDCtx(unpacker); }
};

// Throws std::bad_alloc where the library has no memory.
template <typename Pointer>
Pointer made(Pointer pointer) {
  if (!pointer) throw std::bad_alloc();
  return pointer;
}

auto make_unpacker() {
  auto unpacker = made(std::unique_ptr<ZSTD_DCtx, FreeUnpacker>(ZSTD_createDCtx()));
  // 8 MB, the largest window that the zstd program writes without --ultra or --long.
  ZSTD_DCtx_setParameter(unpacker.get(), ZSTD_d_windowLogMax, 23);
  return unpacker;
}

}  // namespace

bool is_zstd(std::string_view bytes) { return bytes.starts_with("\x28\xb5\x2f\xfd"); }

void pack_zstd(std::FILE* plain, OutputFile& packed) {
  const auto packer = made(std::unique_ptr<ZSTD_CCtx, FreePacker>(ZSTD_createCCtx()));
  ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_compressionLevel, kLevel);
  ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_checksumFlag, 1);
  std::vector<char> in(kPiece), out(kPiece);
  std::rewind(plain);
  for (bool last = false; !last;) {
    const std::size_t size = std::fread(in.data(), 1, in.size(), plain);
    if (std::ferror(plain) != 0) throw WorkError("zstd: the file to compress cannot be read back");
    last = size < in.size();
    ZSTD_inBuffer input{in.data(), size, 0};
    for (bool done = false; !done;) {
      ZSTD_outBuffer output{out.data(), out.size(), 0};
      const std::size_t left =
          ZSTD_compressStream2(packer.get(), &output, &input, last ? ZSTD_e_end : ZSTD_e_continue);
      if (ZSTD_isError(left) != 0) throw WorkError(std::string("zstd: ") + ZSTD_getErrorName(left));
      packed.write(out.data(), output.pos);
      done = last ? left == 0 : input.pos == input.size;
    }
  }
}

std::string unpack_zstd(std::string_view packed, std::uint64_t most_bytes) {
  const auto unpacker = make_unpacker();
  std::string content;
  std::vector<char> out(kPiece);
  ZSTD_inBuffer input{packed.data(), packed.size(), 0};
  std::size_t left = 1;
  while (left != 0 || input.pos < input.size) {
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    left = ZSTD_decompressStream(unpacker.get(), &output, &input);
    if (ZSTD_isError(left) != 0) {
      throw InputError(std::string("is damaged (zstd: ") + ZSTD_getErrorName(left) + "); copy it again");
    }
    if (content.size() + output.pos > most_bytes) {
      throw InputError("unpacks to more than " + std::to_string(most_bytes) +
                       " bytes; unpack it with zstd -d first");
    }
    content.append(out.data(), output.pos);
    const bool starved = output.pos < output.size && input.pos == input.size;
    if (left != 0 && starved) throw InputError("is damaged (zstd: it ends too early); copy it again");
  }
  return content;
}

std::string unpack_zstd_start(std::string_view packed, std::size_t bytes) {
  const auto unpacker = make_unpacker();
  std::string content(bytes, '\0');
  ZSTD_inBuffer input{packed.data(), packed.size(), 0};
  ZSTD_outBuffer output{content.data(), content.size(), 0};
  while (output.pos < output.size && input.pos < input.size) {
    if (ZSTD_isError(ZSTD_decompressStream(unpacker.get(), &output, &input)) != 0) break;
  }
  content.resize(output.pos);
  return content;
}

}  // namespace astrolith
