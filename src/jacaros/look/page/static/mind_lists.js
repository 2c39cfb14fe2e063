import { element } from "./elements.js";
import { whyButton } from "./jumps.js";
import { age } from "./section.js";

/** The rules of an agent. */
export class RuleList {
  constructor() { this.hideEmpty = true; }

  count(mind, t) { return mind.program(t).rules.length; }
  stamp(mind, t) { return String(mind.programs.since(t)); }
  nodes(mind, t) { return [element("ul", "rules", ...mind.program(t).rules.map((rule) => element("li", "", element("code", "", rule))))]; }
}

/** The messages that an agent has not read yet. */
export class MailList {
  constructor(context) {
    this.context = context;
    this.hideEmpty = true;
  }

  count(mind, t) { return mind.mailbox.at(t).size; }
  stamp(mind, t) { return String(mind.mailbox.countAt(t)); }

  nodes(mind, t) {
    return [element("ul", "mail", ...mind.mailboxAt(t).map((message) => element("li", "", element("b", "", message.from), ` ${message.performative} `,
      element("code", "", message.content), " ", age(message.since), " ", whyButton(this.context, { agent: mind.name, cause: message.id }, `mail ${message.id}`))))];
  }
}
