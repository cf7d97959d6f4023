#include "numerics/files/zstd_stream.h"

#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
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
  // Into one piece of memory, which needs none of the frame's window beside it: a few bytes may declare 8 MB.
  constexpr std::uint64_t kLikelyGrowth = 4;
  const auto unpacker = made(std::unique_ptr<ZSTD_DCtx, FreeUnpacker>(ZSTD_createDCtx()));
  for (std::uint64_t room = kLikelyGrowth * packed.size();; room *= 2) {
    std::string content(std::min(room, most_bytes), '\0');
    const std::size_t size =
        ZSTD_decompressDCtx(unpacker.get(), content.data(), content.size(), packed.data(), packed.size());
    if (ZSTD_isError(size) == 0 && !packed.empty()) {
      content.resize(size);
      content.shrink_to_fit();
      return content;
    }
    const ZSTD_ErrorCode error = ZSTD_getErrorCode(size);
    if (error == ZSTD_error_srcSize_wrong || packed.empty())
      throw InputError("is damaged (zstd: it ends too early); copy it again");
    if (error != ZSTD_error_dstSize_tooSmall)
      throw InputError(std::string("is damaged (zstd: ") + ZSTD_getErrorName(size) + "); copy it again");
    if (room >= most_bytes) {
      throw InputError("unpacks to more than " + std::to_string(most_bytes) +
                       " bytes; unpack it with zstd -d first");
    }
  }
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
