// A recipe with all its lengths multiplied: the schema says of every number whether it is a length. What has a unit of its own,
// such as the donors of a morph, stays.
export function scaledRecipe(values, document, factor) {
  "use strict";
  const POWERS = {"length": 1, "cycles per length": -1, "per squared length": -2};
  const OWN_UNIT = ["donors", "donor", "bodies"];

  const scaledNumbers = (value, by) => Array.isArray(value) ? value.map(item => scaledNumbers(item, by))
    : typeof value === "number" ? value * by : value;

  // The node for an object's value: of several kinds that of its type.
  function nodeOf(given, value) {
    const node = values.resolved(given);
    if (!node || !node.oneOf || !value || typeof value !== "object") return node;
    return node.oneOf.map(values.resolved).find(kind => kind.properties && kind.properties.type &&
      (values.resolved(kind.properties.type).enum || []).includes(value.type)) || node;
  }

  function scaled(given, value) {
    const node = nodeOf(given, value);
    if (!node || value === undefined) return value;
    const power = POWERS[node.unit];
    if (power) return scaledNumbers(value, Math.pow(factor, power));
    if (Array.isArray(value)) {
      return value.map((item, at) => scaled(Array.isArray(node.items) ? node.items[at] : node.items, item));
    }
    if (value === null || typeof value !== "object" || !node.properties) return value;
    if (value.type === "relief" && value.donor) return {...value, donor_scale: (value.donor_scale || 1) * factor};
    return Object.fromEntries(Object.entries(value).map(([key, item]) =>
      [key, OWN_UNIT.includes(key) ? item : scaled(node.properties[key], item)]));
  }

  return scaled(values.schema, document);
}
