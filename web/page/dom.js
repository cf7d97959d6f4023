// Short words for elements of the page.
export const at = id => document.getElementById(id);

export function element(tag, {ariaLabel, ...properties}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  if (ariaLabel) made.setAttribute("aria-label", ariaLabel);
  made.append(...children.filter(child => child !== null && child !== undefined));
  return made;
}

export function download(blob, name) {
  const link = element("a", {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Copies a text, and shows on the button that it did.
export async function copyText(text, button) {
  const words = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch (error) {  // no clipboard in this page: an older way
    const box = element("textarea", {value: text});
    document.body.append(box);
    box.select();
    document.execCommand("copy");
    box.remove();
  }
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = words; }, 1500);
}

// A word of a shell's command, in quotes where it needs them.
export const shellWord = text => /^[\w.+:@%/][\w.+:@%/-]*$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`;

// Three significant digits, with commas.
const numbers = new Intl.NumberFormat("en", {maximumFractionDigits: 6});
export const shortNumber = x => numbers.format(Number(x.toPrecision(3)));
