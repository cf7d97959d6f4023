// Debian's OpenCV draws into windows by GLX, which nothing here asks for. These functions take GLX's place in
// wheels, which carry an OpenCV without that library (scripts/wheel.sh).
extern "C" {
__attribute__((visibility("default"))) void* glXGetCurrentContext() { return nullptr; }
__attribute__((visibility("default"))) void* glXGetCurrentDisplay() { return nullptr; }
__attribute__((visibility("default"))) void* glXGetProcAddressARB(const unsigned char* /*name*/) {
  return nullptr;
}
}
