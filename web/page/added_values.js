// The values with which something new starts, so that it shows on a body of this size: the table `added` of recipe/knobs.json,
// and what the schema says.
export function addedValues(table, values) {
  "use strict";
  const rounded = x => Number(x.toPrecision(3));
  function put(holder, path, value) {
    const keys = path.split("."), last = keys.pop();
    for (const key of keys) holder = holder[key] = holder[key] || {};
    holder[last] = value;
  }
  // `name` is a kind of layer, or a field of one, such as craters.population.
  function started(name, node, size) {
    const made = values.fresh(node, size), {sizes = {}, values: others = {}} = table.added[name] || {};
    for (const [path, [share, power]] of Object.entries(sizes)) put(made, path, rounded(share * Math.pow(size, power)));
    for (const [path, value] of Object.entries(others)) put(made, path, value);
    return made;
  }
  return {
    item: (kind, type, size) => ({...started(type, kind, size), type}),
    field: (owner, key, node, size) => started(owner && owner.type ? `${owner.type}.${key}` : key, node, size),
  };
}
