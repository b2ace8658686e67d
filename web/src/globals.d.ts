/** Whether the horse was available when the page was built (vite.config.js). */
declare const HAS_HORSE: boolean;
