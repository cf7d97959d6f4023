// A form for a document, made of its JSON schema alone: a slider or a box for each field with its meaning, unit, limits and
// default. `editing` is the document:
//   get(path), set(path, value, gesture), move(path, step)
//   lengthUnit(), size()       of the document's lengths
//   changed()                  is called after each change by the user
//   isOff(path), switchItem(path, on)   for lists whose items can be switched off, those of kinds
//   added                      what something new starts with: item(kind, type, size), field(owner, key, node, size)
import {element} from "./dom.js";
import {recipeText} from "./recipe_text.js";

export function schemaForm(container, values, editing) {
  "use strict";
  const MOST_SHOWN = 12, MOST_FOUND = 40;
  const open = new Set([""]);       // the groups that the user has open, by their paths
  const shown = new Map();          // how many items of a long list are shown
  const fields = new Map();         // the element of each path that is in the form

  const pathText = path => path.reduce((text, key) => typeof key === "number" ? `${text}[${key}]` : text ? `${text}.${key}` : key, "");

  const button = (text, title, act) => element("button", {type: "button", textContent: text, title, ariaLabel: title, onclick: act});

  function change(path, value, gesture) {
    editing.set(path, value, gesture);
    const holder = fields.get(pathText(path));
    if (holder) holder.classList.remove("unset");
    editing.changed();
  }
  // A change after which the form has other fields. It may give the labels of what then has the focus: the first that is there.
  function reshape(act) {
    rebuild(act());
    editing.changed();
  }
  const stop = act => event => { event.preventDefault(); reshape(act); };

  // -- one value -------------------------------------------------------------------------------------------------------

  function slider(path, node, value, take) {
    const range = values.slide(node, value, editing.size());
    if (!range) return null;
    const at = v => range.log ? Math.log(v / range.low) / Math.log(range.high / range.low) : (v - range.low) / (range.high - range.low);
    const from = t => range.log ? range.low * Math.pow(range.high / range.low, t) : range.low + t * (range.high - range.low);
    const whole = node.type === "integer";
    const steps = whole ? range.high - range.low : 400;
    const made = element("input", {
      type: "range", min: 0, max: steps, step: 1, value: Math.round(at(value) * steps), ariaLabel: pathText(path),
    });
    made.oninput = () => {
      const v = from(made.value / steps);
      take(whole ? Math.round(v) : Number(v.toPrecision(4)), "slide " + pathText(path));
    };
    made.onchange = () => editing.endGesture();
    made.show = v => { made.value = Math.round(at(v) * steps); };
    return made;
  }

  function numberField(path, node, value) {
    const whole = node.type === "integer";
    const box = element("input", {
      type: "text", inputMode: whole ? "numeric" : "decimal", value: recipeText.digits(value), ariaLabel: pathText(path), className: "number",
    });
    const made = slider(path, node, Number(recipeText.digits(value)), (v, gesture) => {
      box.value = v;
      change(path, v, gesture);
    });
    box.onchange = () => {
      const text = box.value.trim();
      const v = whole ? recipeText.integer(text) : Number(text);
      const good = text !== "" && (recipeText.isBig(v) || Number.isFinite(v));
      box.setAttribute("aria-invalid", String(!good));
      if (!good) return;
      if (made) made.show(Number(text));
      change(path, v);
    };
    return element("span", {className: "inputs"}, made, box);
  }

  function textField(path, value, take = text => text) {
    const long = value.length > 60;
    const box = element(long ? "textarea" : "input", {value, ariaLabel: pathText(path), spellcheck: false});
    if (value.length > 4000) Object.assign(box, {readOnly: true, value: `${value.slice(0, 80)} … (${value.length} characters)`});
    box.onchange = () => {
      try {
        change(path, take(box.value));
        box.setAttribute("aria-invalid", "false");
      } catch (error) {
        box.setAttribute("aria-invalid", "true");
      }
    };
    return box;
  }

  // Lists and maps of plain values as JSON text.
  const jsonField = (path, value) => textField(path, recipeText.write(value).replace(/\n\s*/g, " "), recipeText.read);

  function chooser(path, words, value, reshapes) {
    const made = element("select", {ariaLabel: pathText(path)}, ...words.map(word => element("option", {value: word, textContent: word})));
    made.value = value;
    made.onchange = () => reshapes ? reshape(() => editing.set(path, made.value)) : change(path, made.value);
    return made;
  }

  function switchField(path, value) {
    const onchange = event => change(path, event.target.checked);
    return element("input", {type: "checkbox", checked: value, ariaLabel: pathText(path), onchange});
  }

  function rowField(path, node, value) {
    return element("span", {className: "row"}, ...value.map((number, i) => {
      const box = element("input", {type: "text", inputMode: "decimal", value: number, ariaLabel: `${pathText(path)}[${i}]`});
      box.onchange = () => {
        const v = Number(box.value);
        if (box.value.trim() === "" || !Number.isFinite(v)) return box.setAttribute("aria-invalid", "true");
        box.setAttribute("aria-invalid", "false");
        // The whole row: it may stand for a default.
        change(path, (editing.get(path) || value).map((old, k) => k === i ? v : old));
      };
      return box;
    }));
  }

  const isGroup = node => (node.type === "object" && node.properties !== undefined);
  const hasParts = node => isGroup(node) || values.isRow(node);
  const isList = node => node.type === "array" && !values.isFixed(node) &&
    (hasParts(values.resolved(node.items)) || values.kindsOf(node.items).length > 0);

  function valueField(path, node, value) {
    if (node.enum) return chooser(path, node.enum, value, path[path.length - 1] === "type");
    if (node.type === "boolean") return switchField(path, value);
    if (node.type === "string") return textField(path, String(value));
    if (values.isNumber(node)) return numberField(path, node, value);
    if (values.isRow(node) && Array.isArray(value)) return rowField(path, node, value);
    return jsonField(path, value);
  }

  // -- a field with its words ------------------------------------------------------------------------------------------

  function meaning(node) {
    const words = [node.description, values.limits(node, editing.lengthUnit())].filter(Boolean).join(" · ");
    return element("small", {textContent: words.replace(/`/g, "")});
  }

  const freshField = (path, node) => editing.added.field(editing.get(path.slice(0, -1)), path[path.length - 1], node, editing.size());

  const addLabel = path => `add ${pathText(path)}`, removeLabel = path => `remove ${pathText(path)}`;
  const adderLabel = path => `add to ${pathText(path)}`;  // of an item of a list

  // Takes back what is stated, unless it must be. The style hides it where nothing is.
  function backButton(path, required) {
    if (required) return null;
    const act = stop(() => { editing.set(path, undefined); return [addLabel(path), pathText(path), adderLabel(path)]; });
    return Object.assign(button("×", removeLabel(path), act), {className: "back"});
  }

  function plainField(path, key, node, required) {
    const given = editing.get(path), value = given !== undefined ? given : node.default;
    const holder = element("div", {className: given === undefined ? "field unset" : "field"});
    fields.set(pathText(path), holder);
    const name = element("span", {className: "name", textContent: key});
    if (value === undefined) {
      const add = button("add", addLabel(path), stop(() => { editing.set(path, freshField(path, node)); return [pathText(path)]; }));
      holder.append(element("div", {className: "head"}, name, add), meaning(node));
      return holder;
    }
    const head = element("div", {className: "head"}, name, valueField(path, node, value), backButton(path, required));
    holder.append(head, meaning(node));
    return holder;
  }

  // A group that opens and closes; what is in it is made when it first opens. Its buttons stand beside the summary, since what is
  // pressed must not hold buttons itself.
  function group(path, head, buttons, fill) {
    const key = pathText(path);
    const body = element("div", {className: "body"});
    const details = element("details", {open: open.has(key)}, element("summary", {}, head), body);
    const made = element("div", {className: "group"}, details, element("span", {className: "buttons"}, ...buttons));
    fields.set(key, made);
    let filled = false;
    const fillOnce = () => {
      if (filled) return;
      filled = true;
      fill(body);
    };
    if (details.open) fillOnce();
    made.fillNow = () => { open.add(key); details.open = true; fillOnce(); };
    details.ontoggle = () => {
      details.open ? open.add(key) : open.delete(key);
      if (details.open) fillOnce();
    };
    return made;
  }

  function objectField(path, key, node, required) {
    const value = editing.get(path);
    if (value === undefined) {
      const holder = element("div", {className: "field unset"});
      fields.set(pathText(path), holder);
      holder.append(element("div", {className: "head"}, element("span", {className: "name", textContent: key}),
        button("add", addLabel(path), stop(() => {
          editing.set(path, freshField(path, node));
          open.add(pathText(path));
          return [removeLabel(path)];
        }))), meaning(node));
      return holder;
    }
    return group(path, key, [backButton(path, required)], body => {
      body.append(meaning(node), ...objectFields(path, node));
    });
  }

  // All fields but those that allow one value only. What has a value or a default comes first.
  function objectFields(path, node) {
    const required = node.required || [];
    const all = Object.keys(node.properties).map(key => [key, values.resolved(node.properties[key])])
      .filter(([, child]) => child.minimum === undefined || child.minimum !== child.maximum);
    const has = ([key, child]) => editing.get([...path, key]) !== undefined || child.default !== undefined;
    return [...all.filter(has), ...all.filter(pair => !has(pair))]
      .map(([key, child]) => field([...path, key], key, child, required.includes(key)));
  }

  function field(path, key, node, required) {
    if (isGroup(node)) return objectField(path, key, node, required);
    if (isList(node)) return listField(path, key, node, required);
    return plainField(path, key, node, required);
  }

  // -- lists -----------------------------------------------------------------------------------------------------------

  function itemButtons(path, count) {
    const list = path.slice(0, -1), at = path[path.length - 1];
    const upLabel = to => `move ${pathText(to)} up`, downLabel = to => `move ${pathText(to)} down`;
    const moved = step => stop(() => {
      if (!editing.move(path, step)) return;
      swapOpen(path, step);
      const to = [...list, at + step], labels = [upLabel(to), downLabel(to)];
      return step < 0 ? labels : labels.reverse();
    });
    return [
      at > 0 ? button("↑", upLabel(path), moved(-1)) : null,
      at + 1 < count ? button("↓", downLabel(path), moved(1)) : null,
      button("×", removeLabel(path), stop(() => {
        closeFrom(path);
        editing.set(path, undefined);
        return [removeLabel(path), adderLabel(list)];
      })),
    ];
  }

  // Groups stay open with the item that moves.
  function swapOpen(path, step) {
    const here = pathText(path), there = pathText([...path.slice(0, -1), path[path.length - 1] + step]);
    const moved = [...open].map(key =>
      key.startsWith(here) ? there + key.slice(here.length) : key.startsWith(there) ? here + key.slice(there.length) : key);
    open.clear();
    moved.forEach(key => open.add(key));
  }
  function closeFrom(path) {
    const list = pathText(path.slice(0, -1)) + "[";
    [...open].filter(key => key.startsWith(list)).forEach(key => open.delete(key));
  }

  function itemTitle(value, at) {
    const words = [value.type, value.name].filter(Boolean).join(" · ");
    return `${at + 1}  ${words}`;
  }

  function kindItem(path, kinds, value, count) {
    const kind = kinds.find(k => values.wordsOf(k).includes(value.type));
    const on = element("input", {type: "checkbox", checked: !editing.isOff(path), title: "on or off", ariaLabel: `${pathText(path)} on`});
    on.onchange = () => { editing.switchItem(path, on.checked); editing.changed(); };
    const buttons = [editing.canSwitch(path) ? on : null, ...itemButtons(path, count)];
    return group(path, itemTitle(value, path[path.length - 1]), buttons, body => {
      if (kind) body.append(...objectFields(path, kind));
      else body.append(jsonField(path, value));
    });
  }

  function rowItem(path, node, value, count) {
    const number = element("span", {className: "index", textContent: path[path.length - 1] + 1});
    const head = element("div", {className: "head"}, number, rowField(path, node, value), ...itemButtons(path, count));
    const holder = element("div", {className: "field"}, head);
    fields.set(pathText(path), holder);
    return holder;
  }

  function listItem(path, items, value, count) {
    const kinds = values.kindsOf(items), node = values.resolved(items);
    if (kinds.length > 0) return kindItem(path, kinds, value, count);
    if (values.isRow(node)) return rowItem(path, node, value, count);
    return group(path, itemTitle(value, path[path.length - 1]), itemButtons(path, count), body => body.append(...objectFields(path, node)));
  }

  // What makes a new item: a button, and a choice before it where there are kinds.
  function adder(path, items) {
    const kinds = values.newKindsOf(items);
    const add = value => stop(() => {
      const list = editing.get(path) || [];
      editing.set(path, [...list, value()]);
      open.add(pathText(path));
      open.add(pathText([...path, list.length]));
      shown.set(pathText(path), Math.max(shown.get(pathText(path)) || 0, list.length + 1));
    });
    if (kinds.length === 0) return [button("add", adderLabel(path), add(() => values.fresh(items, editing.size())))];
    const words = kinds.flatMap(values.wordsOf);
    const choice = element("select", {ariaLabel: `kind to ${adderLabel(path)}`},
      ...words.map(word => element("option", {value: word, textContent: word})));
    return [choice, button("add", adderLabel(path), add(() => newOfKind(kinds, choice.value)))];
  }

  const newOfKind = (kinds, word) => editing.added.item(kinds.find(k => values.wordsOf(k).includes(word)), word, editing.size());

  function listField(path, key, node, required) {
    const given = editing.get(path), list = given || [];
    const text = pathText(path);
    const buttons = [...adder(path, node.items), given === undefined ? null : backButton(path, required)];
    return group(path, `${key} (${list.length})`, buttons, body => {
      const most = Math.max(shown.get(text) || MOST_SHOWN, MOST_SHOWN);
      body.append(meaning(node), ...list.slice(0, most).map((value, at) => listItem([...path, at], node.items, value, list.length)));
      if (list.length > most) {
        body.append(button(`${list.length - most} more`, `more of ${text}`, () => { shown.set(text, most + 100); rebuild(); }));
      }
    });
  }

  // -- the whole -------------------------------------------------------------------------------------------------------

  let sought = "";  // the words that the user looks for

  // The fields, at any depth, whose path or meaning has all the words.
  function soughtFields() {
    const words = sought.toLowerCase().split(/\s+/), made = [];
    const fits = (path, node) => words.every(word => `${pathText(path)} ${node.description || ""}`.toLowerCase().replace(/_/g, " ").includes(word.replace(/_/g, " ")));
    const visit = (path, node) => {
      if (made.length >= MOST_FOUND) return;
      const value = editing.get(path), key = path[path.length - 1];
      if (isGroup(node)) {
        if (value === undefined && path.length > 0) return fits(path, node) && made.push(objectField(path, pathText(path), node, false));
        return Object.keys(node.properties).forEach(name => visit([...path, name], values.resolved(node.properties[name])));
      }
      if (isList(node)) {
        return (value || []).slice(0, MOST_SHOWN).forEach((item, at) => visit([...path, at], values.kindOf(node.items, item) || values.resolved(node.items)));
      }
      if (typeof key === "string" && fits(path, node) && (node.minimum === undefined || node.minimum !== node.maximum)) made.push(plainField(path, pathText(path), node, false));
    };
    visit([], values.resolved(values.schema));
    return made.length > 0 ? made : [element("p", {textContent: "No field of this recipe has these words."})];
  }

  // What the body is made of comes first, and what is said about it last.
  function allFields() {
    const all = objectFields([], values.resolved(values.schema)), parts = all.filter(made => made.className === "group");
    return [...parts, ...all.filter(made => !parts.includes(made))];
  }

  // `focus` are the labels of what may have the focus then; without it that stays where it is.
  function rebuild(focus = [document.activeElement && document.activeElement.getAttribute("aria-label")]) {
    fields.clear();
    container.replaceChildren(...sought ? soughtFields() : allFields());
    const labelled = [...container.querySelectorAll("[aria-label]")];
    const again = focus.map(label => labelled.find(made => made.getAttribute("aria-label") === label)).find(Boolean);
    if (again) again.focus({preventScroll: true});
  }
  function seek(text) {
    sought = text.trim();
    rebuild();
  }

  function clear() {
    container.querySelectorAll(".refusal").forEach(made => made.remove());
    container.querySelectorAll(".refused").forEach(made => made.classList.remove("refused"));
  }

  // Opens the groups around a path and shows the words beside its field, or beside the nearest that the form has.
  function refuse(path, words) {
    clear();
    for (let depth = 1; depth <= path.length; ++depth) {
      const around = fields.get(pathText(path.slice(0, depth)));
      if (around && around.fillNow && depth < path.length) around.fillNow();
    }
    for (let depth = path.length; depth > 0; --depth) {
      const made = fields.get(pathText(path.slice(0, depth)));
      if (!made) continue;
      made.classList.add("refused");
      const note = element("div", {className: "refusal", textContent: words});
      note.setAttribute("role", "alert");
      made.append(note);
      return true;
    }
    return false;
  }

  return {rebuild, seek, refuse, clear, open: path => open.add(path)};
}
