// Light and dark, the list of contents, buttons that copy and save.

const listeners = new Set();

export function onThemeChange(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function cssColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export function makeTheme() {
  const show = (theme) => {
    document.documentElement.dataset.theme = theme;
    for (const listener of listeners) listener();
  };
  document.getElementById("theme").addEventListener("click",
    () => show(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (dark) => show(dark.matches ? "dark" : "light"));
}

export function makeContents() {
  const contents = document.getElementById("contents");
  contents.replaceChildren();
  for (const section of document.querySelectorAll("main > section")) {
    const link = document.createElement("a");
    link.href = "#" + section.id;
    link.textContent = section.id[0].toUpperCase() + section.id.slice(1).replace("-", " ");
    link.title = section.querySelector("h2").textContent;
    contents.append(link);
  }
}

/// An element with attributes and children; texts stay texts.
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in element && typeof value !== "string") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

export function save(name, blob) {
  const link = make("a", {download: name, href: URL.createObjectURL(blob)});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/// The clipboard of a page opened as a file may be closed to it; the text is then selected instead.
async function copy(source) {
  try {
    await navigator.clipboard.writeText(source.textContent);
    return "Copied";
  } catch {
    const details = source.closest("details");
    if (details) details.open = true;
    getSelection().selectAllChildren(source);
    return document.execCommand("copy") ? "Copied" : "Selected: copy by hand";
  }
}

export function makeTools() {
  for (const button of document.querySelectorAll("button[data-copy]")) {
    const said = button.textContent;
    button.addEventListener("click", async () => {
      button.textContent = await copy(document.getElementById(button.dataset.copy));
      setTimeout(() => (button.textContent = said), 1500);
    });
  }
  for (const button of document.querySelectorAll("button[data-save]"))
    button.addEventListener("click", () =>
      save(button.dataset.name, new Blob([document.getElementById(button.dataset.save).textContent], {type: "text/yaml"})));
}
