// What the browser keeps of the page, of each copy by itself: the recipe that was edited last, {name, text}, and whether this tab showed it.
export const kept = (function () {
  "use strict";
  const KEY = `astrolith recipe ${location.pathname}`, SHOWN = `astrolith shown ${location.pathname}`;
  let waits = 0;
  const quietly = work => { try { return work(); } catch (error) { return null; } };  // a browser may keep nothing
  return {
    // Soon, since a knob that is dragged changes the recipe many times a second.
    keep(name, text) {
      clearTimeout(waits);
      const now = () => quietly(() => localStorage.setItem(KEY, JSON.stringify({name, text: text()})));
      waits = setTimeout(() => window.requestIdleCallback ? requestIdleCallback(now, {timeout: 1000}) : now(), 300);
    },
    recipe: () => quietly(() => JSON.parse(localStorage.getItem(KEY))),
    tellShown: isShown => quietly(() => isShown ? sessionStorage.setItem(SHOWN, "yes") : sessionStorage.removeItem(SHOWN)),
    wasShown: () => quietly(() => sessionStorage.getItem(SHOWN)) === "yes",
  };
})();
