// What the core asks of its host (page_core.h). The module's owner may set Module.goesOn.
mergeInto(LibraryManager.library, {
  astrolith_host_goes_on: function (fraction) {
    return Module["goesOn"] && !Module["goesOn"](fraction) ? 0 : 1;
  },
});
