#!/usr/bin/env bash
# Builds libraries for wheels into build/wheel-packages, from Debian's sources: Cairo without X11, which a bare system lacks, and
# libtiff without JBIG, which is under the GPL, archives that the modules take in; and Embree with triangles and single rays alone,
# in a seventh of the bytes of Debian's. Adds a font. Some ten processor minutes, nearly all of them Embree's.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=$PWD/build/wheel-packages
work=$packages/work
[[ -e $packages/lib/libcairo.a && -e $packages/lib/libtiff.a && -e $packages/share/fonts && -e $packages/lib/libembree3.so ]] && exit 0
scripts/setup.sh --synth --wheel

mkdir -p "$packages/share/fonts"
cp /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf "$packages/share/fonts/"
cp /usr/share/doc/fonts-dejavu-core/copyright "$packages/share/fonts/DejaVuSans.txt"
cat >"$packages/share/fonts/fonts.conf" <<'END'
<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "urn:fontconfig:fonts.dtd">
<fontconfig><dir prefix="relative">.</dir><cachedir prefix="xdg">fontconfig</cachedir></fontconfig>
END

# Debian's archive of sources, as the system names Debian's archive of packages.
rm -rf "$work"
mkdir -p "$work/lists/partial" "$work/sources"
for file in /etc/apt/sources.list /etc/apt/sources.list.d/debian.*; do
  [[ -e $file ]] && sed -E 's/^Types: .*/Types: deb-src/; s/^deb /deb-src /' "$file" >"$work/sources/$(basename "$file")"
done
apt=(apt-get -qq -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$work/sources" -o "Dir::State::Lists=$work/lists"
  -o APT::Sandbox::User=root)
cd "$work"
"${apt[@]}" update
"${apt[@]}" source --tar-only cairo tiff embree
for archive in *.orig.tar.*; do tar xf "$archive"; done

# logged NAME COMMAND ...: keeps what a command says in a file, and prints the end of it where the command fails.
logged() { "${@:2}" >"$work/$1.log" 2>&1 || { tail -30 "$work/$1.log" >&2; return 1; }; }
logged tiff cmake -G Ninja -S libtiff-* -B tiff -DCMAKE_BUILD_TYPE=Release "-DCMAKE_INSTALL_PREFIX=$packages" \
  -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_SHARED_LIBS=OFF \
  -D{jbig,webp,lerc,jpeg,lzma,zstd,libdeflate,cxx,tiff-tools,tiff-tests,tiff-contrib,tiff-docs}=OFF
logged tiff cmake --build tiff --target install

mkdir -p cairo
cd cairo
logged cairo ../cairo-*/configure -q --prefix="$packages" --disable-shared --enable-static --with-pic --disable-dependency-tracking \
  --disable-{xlib,xcb,gobject,trace,interpreter,script,gtk-doc} CFLAGS="-O2 -fvisibility=hidden -w"
logged cairo make -s -j2 install

cd "$work"
touch "$(echo embree-*)/readme.pdf"  # which Debian leaves out and the installation names
logged embree cmake -G Ninja -S embree-* -B embree -DCMAKE_BUILD_TYPE=Release "-DCMAKE_INSTALL_PREFIX=$packages" \
  -DCMAKE_INSTALL_LIBDIR=lib -DEMBREE_TASKING_SYSTEM=TBB -DEMBREE_MAX_ISA=NONE -DEMBREE_ISA_{SSE2,AVX,AVX2}=ON \
  -DEMBREE_ISA_{SSE42,AVX512}=OFF -DEMBREE_{ISPC_SUPPORT,TUTORIALS,RAY_PACKETS,RAY_MASK,FILTER_FUNCTION,BACKFACE_CULLING}=OFF \
  -DEMBREE_GEOMETRY_{QUAD,CURVE,SUBDIVISION,USER,INSTANCE,GRID,POINT}=OFF
logged embree cmake --build embree --target install
