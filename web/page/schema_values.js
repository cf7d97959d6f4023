// What a JSON schema says of a value: its meaning, limits, what a new one is like. Knows no recipe.
export function schemaValues(schema) {
  "use strict";
  const FAR = 1e6;  // limits beyond it say nothing of what is usual

  // The node with what it refers to; what stands beside the reference wins. A number whose default depends on where it stands
  // has `defaults`, by name, and no default.
  function resolved(node) {
    while (node && node.$ref) {
      const {$ref, ...beside} = node;
      node = {...$ref.slice(2).split("/").reduce((at, key) => at[key], schema), ...beside};
    }
    if (!isNumber(node) || typeof node.default !== "object") return node;
    const {default: defaults, ...beside} = node;
    return {...beside, defaults};
  }
  const isNumber = node => node.type === "number" || node.type === "integer";

  // The node of an item of a list, which may say what each item is, or what all are.
  const itemNode = (list, at) => resolved(Array.isArray(list.items) ? list.items[at] : list.items);
  const isFixed = list => list.type === "array" && list.minItems !== undefined && list.minItems === list.maxItems;
  // A short list of so many numbers.
  const isRow = list => isFixed(list) && list.maxItems <= 6 &&
    Array.from({length: list.maxItems}, (_, at) => itemNode(list, at)).every(isNumber);

  // The kinds that an item may be, each with a field `type`; empty where there is but one.
  function kindsOf(items) {
    return (resolved(items).oneOf || []).map(resolved).filter(kind => kind.properties && kind.properties.type);
  }
  // Those that can be made of nothing: what has an image is made of pixels that nobody types.
  const newKindsOf = items => kindsOf(items).filter(kind => !kind.properties.image);
  const wordsOf = kind => resolved(kind.properties.type).enum;
  const kindOf = (items, value) => kindsOf(items).find(kind => wordsOf(kind).includes(value && value.type));

  // A length of a new item is a twentieth of the body's longest side, where that is known.
  function newNumber(node, size) {
    const sized = {"length": 0.05 * size, "cycles per length": 5 / size, "per squared length": 20 / (size * size)}[node.unit];
    if (sized) return Number(sized.toPrecision(3));
    const least = node.exclusiveMinimum !== undefined ? node.exclusiveMinimum : node.minimum;
    if (node.maximum < 1 || (least === 0 && node.maximum === 1)) return (least + node.maximum) / 2;
    if (least === undefined || least < 1) return 1;
    return node.exclusiveMinimum !== undefined ? least + 1 : least;
  }

  // A value that the schema allows, with the fields that it requires.
  function fresh(given, size) {
    const node = resolved(given);
    if (node.default !== undefined) return JSON.parse(JSON.stringify(node.default));
    if (node.defaults) return Object.values(node.defaults)[0];
    if (node.enum) return node.enum[0];
    const type = node.type;
    if (type === "boolean") return false;
    if (type === "string") return "";
    if (isNumber(node)) return newNumber(node, size);
    if (type === "array") return Array.from({length: node.minItems || 0}, (_, at) => fresh(itemNode(node, at), size));
    if (!node.properties && node.oneOf) return fresh(node.oneOf[0], size);
    const value = {};
    const oneOf = node.oneOf && node.oneOf[0].required || [];
    for (const key of [...(node.required || []), ...oneOf]) value[key] = fresh(node.properties[key], size);
    return value;
  }

  // From where to where a slider for the value goes; null where a slider says nothing. A logarithmic one has `log`.
  function slide(node, value, size) {
    const low = node.exclusiveMinimum !== undefined ? node.exclusiveMinimum : node.minimum, high = node.maximum;
    const near = limit => limit !== undefined && Math.abs(limit) <= FAR;
    if (near(low) && near(high) && (low !== 0 || high <= 1000)) return {low, high};
    if (node.type === "integer") return null;
    const usual = Math.abs(value) || Math.abs(node.default) || (node.unit === "length" ? 0.05 * size : 1);
    if (low > 0 && low < 1e-3) return {low: usual / 32, high: usual * 32, log: true};
    if (near(low)) return {low, high: low + 4 * Math.max(usual - low, 0.25 * usual)};
    return {low: -4 * usual, high: 4 * usual};
  }

  // The unit and the limits in words.
  function limits(node, lengthUnit) {
    const words = [];
    if (node.unit) words.push(node.unit.replace(/\blength\b/, lengthUnit));
    const low = node.exclusiveMinimum !== undefined ? node.exclusiveMinimum : node.minimum;
    if (low !== undefined && low > -FAR && !(low > 0 && low < 1e-6)) words.push((node.exclusiveMinimum !== undefined ? "> " : "≥ ") + low);
    if (low > 0 && low < 1e-6) words.push("> 0");
    if (node.maximum !== undefined && node.maximum < FAR) words.push("≤ " + node.maximum);
    if (node.default !== undefined && typeof node.default !== "object" && node.default !== "") words.push("default " + node.default);
    const named = Object.entries(node.defaults || {}).map(([name, value]) => `${value} (${name})`);
    if (named.length > 0) words.push("default " + named.join(", "));
    return words.join(", ");
  }

  return {schema, resolved, isNumber, isFixed, isRow, kindsOf, newKindsOf, kindOf, wordsOf, fresh, slide, limits};
}
