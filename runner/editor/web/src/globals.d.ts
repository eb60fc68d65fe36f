

declare global {
  interface WindowEventMap {'go-to-line': CustomEvent<number>}
}
export {};
