// Controls for the options of the command line, made from their declarations.

/** An element with properties, attributes and children. */
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-")) element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** Groups that are open at first. */
const OPEN = ["Lines", "Surface", "Page"];
/** Groups in their order on the page; others follow. */
const ORDER = ["Surface", "Camera", "Lines", "Hatching", "Light", "Page", "Pens and plotter", "Axes", "Model", "Output"];
/** Options that are set elsewhere. */
const ELSEWHERE = ["eye", "set"];
/** Options for parametric surfaces only. */
const PARAMETRIC = ["u", "v"];

class Controls {
  /**
   * @param panel where the groups go
   * @param values what is set: option to value
   * @param changed called when something was changed
   */
  constructor(panel, changed) {
    this.panel = panel;
    this.changed = changed;
    this.values = {};
    this.rows = new Map();
  }

  /** Rebuilds everything from what the server reports. */
  build(about, values) {
    this.values = values;
    this.rows.clear();
    const groups = new Map();
    for (const control of about.controls) {
      if (ELSEWHERE.includes(control.name) && (control.name !== "set" || about.formulas)) continue;
      if (PARAMETRIC.includes(control.name) && !("parametric" in about.options)) continue;
      const group = control.name === "view-height" ? "Camera" : control.group;
      if (!groups.has(group)) groups.set(group, []);
      groups.get(group).push(control);
    }
    const rank = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);
    const sorted = [...groups].sort(([a], [b]) => rank(a) - rank(b));
    this.panel.replaceChildren(...sorted.map(([name, controls]) => {
      const rows = controls.map((control) => this.row(control));
      return make("details", { className: "group", open: OPEN.includes(name) },
        make("summary", { textContent: name }), ...rows);
    }));
    this.refresh();
  }

  row(control) {
    const { name, help, more, kind } = control;
    const id = `option-${name}`;
    const error = make("p", { className: "error", id: `${id}-error`, hidden: true });
    const text = `${more}\n\n--${name}`;
    const words = name.replaceAll("-", " ");
    const label = words.length > 1 ? words[0].toUpperCase() + words.slice(1) : words;
    const put = (value) => { this.set(name, control.optional && value === "on" ? true : value); };
    let input, content;
    const attributes = { id, title: text, "aria-describedby": `${id}-error` };
    if (kind === "flag") {
      input = make("input", { type: "checkbox", onchange: () => put(input.checked || undefined), ...attributes });
      content = make("label", { className: "flag", title: text }, input, ` ${label}`);
    } else if (kind === "choice") {
      const choices = control.choices.map(({ name, help }) => make("option", { value: name, textContent: name, title: help }));
      const none = control.default ? [] : [make("option", { value: "", textContent: control.optional ? "off" : "automatic" })];
      if (control.optional) none.push(make("option", { value: "on", textContent: "on" }));
      input = make("select", { onchange: () => put(input.value), ...attributes }, ...none, ...choices);
    } else if (kind === "choices") {
      input = make("fieldset", { ...attributes });
      const boxes = control.choices.map(({ name: choice, help }) => make("label", { title: help },
        make("input", { type: "checkbox", value: choice, onchange: () => {
          const on = [...input.querySelectorAll("input:checked")].map((box) => box.value);
          put(on.join(","));
        } }), ` ${choice}`));
      input.append(make("legend", { textContent: label, title: text }), ...boxes);
      content = input;
    } else {
      const isLong = kind === "texts" || Boolean(kind.several);
      input = make(isLong ? "textarea" : "input", {
        spellcheck: false, autocomplete: "off", ...(isLong ? { rows: 1 } : { type: "text" }),
        inputMode: kind === "number" ? "decimal" : "text",
        placeholder: (control.optional && `on, or ${control.value_name.toLowerCase()}`) || control.default || (isLong ? `${control.value_name}, one a line` : control.value_name.toLowerCase()),
        onchange: () => put(isLong ? input.value.split("\n").map((line) => line.trim()).filter(Boolean) : input.value.trim()),
        ...attributes,
      });
      if (kind === "number") input.addEventListener("keydown", (event) => this.step(event, input));
    }
    content ??= make("div", { className: "pair" }, make("label", { htmlFor: id, textContent: label, title: text }), input);
    const row = make("div", { className: "row" }, content, error);
    this.rows.set(name, { control, input, row, error });
    row.dataset.help = help;
    return row;
  }

  /** Arrow keys step a number by a tenth of its size, or by one degree. */
  step(event, input) {
    const sign = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    const value = Number(input.value || input.placeholder);
    if (!sign || !Number.isFinite(value)) return;
    event.preventDefault();
    const size = Math.max(Math.abs(value) / 10, 1e-9);
    const step = Math.abs(value) >= 10 ? 1 : 10 ** Math.floor(Math.log10(size));
    input.value = brief(value + sign * step);
    input.dispatchEvent(new Event("change"));
  }

  set(name, value) {
    const isNothing = value === undefined || value === "" || (Array.isArray(value) && !value.length);
    if (isNothing || value === this.rows.get(name)?.control.default) delete this.values[name];
    else this.values[name] = value;
    this.mark(name);
    this.changed(name, value);
  }

  /** Shows what is set. */
  refresh() {
    for (const [name, { control, input }] of this.rows) {
      const value = control.optional && this.values[name] === true ? "on" : this.values[name];
      const shown = value ?? "";
      if (control.kind === "flag") input.checked = value === true;
      else if (control.kind === "choice") input.value = value ?? control.default;
      else if (control.kind === "choices") {
        const on = String(value ?? control.default).split(",");
        for (const box of input.querySelectorAll("input")) box.checked = on.includes(box.value);
      } else if (document.activeElement !== input) {
        input.value = Array.isArray(shown) ? shown.join("\n") : shown;
        if (input.tagName === "TEXTAREA") input.rows = Math.max(1, input.value.split("\n").length);
      }
      this.mark(name);
    }
  }

  mark(name) {
    this.rows.get(name)?.row.classList.toggle("changed", name in this.values);
  }

  /** Shows an error at its option; returns whether there is such an option. */
  fail(name, message) {
    for (const { input, error } of this.rows.values()) {
      error.hidden = true;
      input.removeAttribute("aria-invalid");
    }
    const row = name && this.rows.get(name);
    if (!row) return false;
    row.error.textContent = message;
    row.error.hidden = false;
    row.input.setAttribute("aria-invalid", "true");
    row.row.closest("details").open = true;
    return true;
  }
}
